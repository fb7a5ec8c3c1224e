#!/usr/bin/env bash
# Runs every fuzzer of BUILD for MINUTES, JOBS at a time, from the committed corpora and what earlier runs found; prints a
# table, and fails where there is a finding. Findings are left in BUILD/findings. NAMES: only these.
# Use: scripts/fuzz.sh BUILD MINUTES JOBS [NAMES...]
set -euo pipefail
source=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "$1" && pwd) minutes=$2 jobs=$3
shift 3
names=("$@")
if [ ${#names[@]} -eq 0 ]; then
  for program in "$build"/bin/fuzz_*; do names+=("$(basename "$program" | sed s/^fuzz_//)"); done
fi

# One allocation of more than 2 GiB is a finding: no input here is large.
export ASAN_OPTIONS=max_allocation_size_mb=2048:detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1
mkdir -p "$build/findings" "$build/logs"

fuzz_one() {
  local name=$1 grown="$build/corpus/$1"
  mkdir -p "$grown"
  local options=(-max_total_time="$(awk "BEGIN { print int($minutes * 60) }")" -timeout=120 -rss_limit_mb=3000
                 -print_final_stats=1 -artifact_prefix="$build/findings/$name-")
  [ ! -f "$source/fuzz/dictionaries/$name.dict" ] || options+=(-dict="$source/fuzz/dictionaries/$name.dict")
  if nice -n 10 "$build/bin/fuzz_$name" "${options[@]}" "$grown" "$source/fuzz/corpus/$name" >"$build/logs/$name" 2>&1
  then echo 0 >"$build/logs/$name.code"
  else echo $? >"$build/logs/$name.code"
  fi
}
export -f fuzz_one
export build minutes source
printf '%s\n' "${names[@]}" | xargs -P "$jobs" -I{} bash -c 'fuzz_one {}'

failed=0
printf '%-14s %12s %9s %9s %7s  %s\n' fuzzer executions per_s branches corpus finding
for name in "${names[@]}"; do
  log="$build/logs/$name"
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  speed=$(sed -n 's/^stat::average_exec_per_sec: *//p' "$log")
  branches=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -1)
  corpus=$(sed -n 's/.* corp: \([0-9]*\).*/\1/p' "$log" | tail -1)
  finding=none
  if [ "$(cat "$log.code")" != 0 ]; then
    finding=$(sed -n -E '/Finding|runtime error|ERROR: (AddressSanitizer|libFuzzer)|what\(\)/{p;q}' "$log" | cut -c1-100)
    finding="${finding:-see} ($log)"
    failed=1
  fi
  printf '%-14s %12s %9s %9s %7s  %s\n' "$name" "${executions:-?}" "${speed:-?}" "${branches:-?}" "${corpus:-?}" "$finding"
done
exit $failed
