#include "raygrain/bvh.h"
