// A fixture: builders must not see rays.
#include "raygrain/ray.h"
