#include "raygrain/heuristics.h"
