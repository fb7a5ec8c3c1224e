#!/usr/bin/env bash
# The floors hold, and the check refuses a file that breaks them.
set -euo pipefail
source=$1
"$source/scripts/check-floors.sh" "$source"
if refusals=$("$source/scripts/check-floors.sh" "$source/tests/project/bad_floor"); then
  echo "the check accepted includes that break the floors" >&2
  exit 1
fi
for fixture in src/base/climber.cpp src/build/ray_seer.cpp; do
  if ! grep -q "^$fixture:" <<<"$refusals"; then
    echo "the check accepted $fixture" >&2
    exit 1
  fi
done
