#!/usr/bin/env bash
# Lists every C++ file of the project, one a line.
set -euo pipefail
cd "$(dirname "$0")/.."
find include src cli tests examples bench fuzz \( -name '*.h' -o -name '*.cpp' \) -print 2>/dev/null | sort
