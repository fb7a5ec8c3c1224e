#include "raygrain/top_level.h"
