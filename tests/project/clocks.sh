#!/usr/bin/env bash
# Clocks that people and networks set go backwards: nothing here may read one. Durations come from steady_clock alone.
set -euo pipefail
cd "$1"
if grep -rnE 'system_clock|high_resolution_clock|gettimeofday|CLOCK_REALTIME|std::time\(|::time\(' include src cli; then
  echo "use std::chrono::steady_clock" >&2
  exit 1
fi
