#include "support/mesh_families.h"
