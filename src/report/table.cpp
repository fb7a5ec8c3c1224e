#include "raygrain/report.h"
