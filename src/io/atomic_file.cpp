#include "raygrain/io.h"
