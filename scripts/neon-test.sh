#!/usr/bin/env bash
# Compiles the searches and their tests for 64-bit Arm and runs them in an emulator: NEON kernels against the oracle on
# any machine. Usage: scripts/neon-test.sh [FOLDER [GTEST_FILTER]]; RAYGRAIN_TEST_SCALE sizes the tests, small by default.
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:-build/neon}
filter=${2:-*}
compiler=aarch64-linux-gnu-g++

for tool in "$compiler" qemu-aarch64; do
  if ! command -v "$tool" >/dev/null; then
    echo "raygrain: error: neon-test: $tool is missing. Run scripts/install-dependencies.sh full" >&2
    exit 1
  fi
done

# Only headers that are the same on every machine: the others must be those of the cross compiler.
mkdir -p "$out/include" "$out/objects"
for package in hwy boost gtest; do ln -sfn "/usr/include/$package" "$out/include/$package"; done

launcher=()
command -v ccache >/dev/null && launcher=(ccache)
flags=(-std=c++20 -O2 -march=armv8-a+crypto -ffp-contract=off -Wall -Wextra -DRAYGRAIN_STD_THREADS -DRAYGRAIN_CHECKS
       -DRAYGRAIN_SHARED_SCENES='""' -DRAYGRAIN_SOURCE_FOLDER='"."' -Wno-psabi -Iinclude -Isrc -Itests -isystem "$out/include"
       -isystem /usr/src/googletest/googletest)
sources=(src/base/*.cpp src/geometry/*.cpp src/build/*.cpp src/trace/*.cpp src/trace/kernels/*.cpp src/rays/*.cpp src/families/*.cpp
         tests/support/*.cpp tests/trace/*.cpp /usr/src/googletest/googletest/src/gtest-all.cc /usr/src/googletest/googletest/src/gtest_main.cc)
compile() {
  local object
  object="$out/objects/$(echo "$1" | tr / _).o"
  "${launcher[@]}" "$compiler" "${flags[@]}" -c "$1" -o "$object"
}
jobs=${JOBS:-$(nproc)}
for source in "${sources[@]}"; do
  while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n; done
  compile "$source" &
done
while [ "$(jobs -rp | wc -l)" -gt 0 ]; do wait -n; done

"$compiler" -static "$out"/objects/*.o -o "$out/test_trace_neon" -lpthread
RAYGRAIN_TEST_SCALE=${RAYGRAIN_TEST_SCALE:-small} qemu-aarch64 "$out/test_trace_neon" --gtest_filter="$filter"
