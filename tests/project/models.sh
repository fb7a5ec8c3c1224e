#!/usr/bin/env bash
# Every model of Debian's assimp-testmodels loads or is refused with an error, as docs/models.md says. At full scale, and
# where the package is installed.
set -euo pipefail
program=$1 source=$2
if [ "${RAYGRAIN_TEST_SCALE:-normal}" != full ]; then
  echo "skipped: RAYGRAIN_TEST_SCALE is not full"
  exit 77
fi
"$source/scripts/check-models.sh" "$program"
