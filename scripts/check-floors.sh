#!/usr/bin/env bash
# Fails when an include points up or sideways: check-floors.sh [ROOT]. The floors are those of ARCHITECTURE.md.
set -euo pipefail
cd "${1:-$(dirname "$0")/..}"

{ find src cli -name '*.h' -o -name '*.cpp'; find include -name '*.h'; } 2>/dev/null | sort | xargs awk '
  BEGIN {
    # module -> floor
    split("base 1 geometry 2 build 3 rays 3 io 4 heuristic 4 trace 4 accel 5 analyze 6 study 7 report 7 cli 8", m, " ")
    for (i = 1; i in m; i += 2) floor[m[i]] = m[i + 1]
    # public header -> module
    h = "error base vec geometry bounds geometry ray geometry mesh geometry frame geometry region geometry area geometry"
    h = h " triangle geometry measure build orientation build bvh build build build rays rays scene io io io"
    h = h " heuristics heuristic registry heuristic trace trace wide trace refine build top_level accel accelerator accel"
    h = h " fields analyze analyze analyze compare study report report raygrain cli"
    split(h, p, " ")
    for (i = 1; i in p; i += 2) owner[p[i]] = p[i + 1]
  }
  function module_of(path,   parts, n) {
    n = split(path, parts, "/")
    if (parts[1] == "src") return parts[2]
    if (parts[1] == "cli") return "cli"
    sub(/\.h$/, "", parts[n])
    return (parts[n] in owner) ? owner[parts[n]] : "?" parts[n]
  }
  FNR == 1 { self = module_of(FILENAME) }
  /^[ \t]*#[ \t]*include[ \t]*"/ {
    target = $0; sub(/^[^"]*"/, "", target); sub(/".*$/, "", target)
    if (target ~ /^raygrain\//) other = module_of("include/" target)
    else if (self == "cli" && target !~ /\//) other = "cli"
    else if (split(target, t, "/") > 1) other = t[1]
    else { print FILENAME ":" FNR ": include \"" target "\" names no module"; bad = 1; next }
    if (self ~ /^\?/ || !(self in floor)) { print FILENAME ": belongs to no floor; add it to scripts/check-floors.sh"; bad = 1; nextfile }
    if (!(other in floor)) { print FILENAME ":" FNR ": \"" target "\" belongs to no floor"; bad = 1; next }
    checked++
    if (other == self || floor[other] < floor[self]) next
    print FILENAME ":" FNR ": " self " (floor " floor[self] ") includes " target " of " other " (floor " floor[other] ")"
    bad = 1
  }
  /^[ \t]*#[ \t]*include[ \t]*<.*(immintrin|arm_neon|hwy\/)/ && FILENAME !~ /^src\/trace\/kernels\// {
    print FILENAME ":" FNR ": SIMD outside src/trace/kernels/"; bad = 1
  }
  FILENAME ~ /^include\// && /^[ \t]*#[ \t]*include[ \t]*<.*[\/.]/ {
    print FILENAME ":" FNR ": public headers use the standard library only"; bad = 1
  }
  END { if (!bad) print checked + 0 " includes point down"; exit bad }'
