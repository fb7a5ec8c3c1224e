#include "raygrain/trace.h"
