#include "raygrain/analyze.h"
