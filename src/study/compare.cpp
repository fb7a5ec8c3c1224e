#include "raygrain/compare.h"
