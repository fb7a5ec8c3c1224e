#!/usr/bin/env bash
# Installs the build and uses it from a project of its own: consumer.sh BUILD_DIR SOURCE_DIR WORK_DIR [LINKER_FLAGS]
set -euo pipefail
build=$1 source=$2 work=$3 linker_flags=${4:-}
rm -rf "$work"
cmake --install "$build" --prefix "$work/prefix" >/dev/null
"$work/prefix/bin/raygrain" --version
cmake -S "$source/tests/project/consumer" -B "$work/build" -DCMAKE_BUILD_TYPE=Release \
      -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_EXE_LINKER_FLAGS="$linker_flags" >/dev/null
cmake --build "$work/build"
"$work/build/consumer"
