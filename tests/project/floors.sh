#!/usr/bin/env bash
# The floors hold, and the check refuses a file that breaks them.
set -euo pipefail
source=$1
"$source/scripts/check-floors.sh" "$source"
if "$source/scripts/check-floors.sh" "$source/tests/project/bad_floor"; then
  echo "the check accepted an include that points up" >&2
  exit 1
fi
