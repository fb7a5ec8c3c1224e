// A fixture: the check of the floors must refuse this file.
#include "raygrain/area.h"
