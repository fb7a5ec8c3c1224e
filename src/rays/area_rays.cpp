#include "raygrain/rays.h"
