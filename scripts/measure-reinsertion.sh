#!/bin/bash
# What reinsertion does to trees: for each scene the ratio (with / without) of estimated, real and pruned cost and of
# build time, and the geometric means.
# Usage: measure-reinsertion.sh PROGRAM RECIPE SCENE...   e.g.  build/release/bin/raygrain PAH+ALL@binned city.obj
set -euo pipefail
program=$1 recipe=$2
shift 2

figures() {  # estimated, real, pruned, seconds
  "$program" analyze "$1" --recipe "$recipe" --sun 0.35,-0.8,0.48 --rays 10000 --quiet --json - "${@:2}" |
    awk -F'[:,]' '
      /"estimated_cost"/ { estimated = $2 } /"real_cost"/ { real = $2 } /"pruned_cost"/ { pruned = $2 }
      /"build_seconds"/ { seconds = $2 } END { print estimated, real, pruned, seconds }'
}

printf '%-32s %10s %8s %8s %9s %9s\n' scene estimated real pruned 'plain s' 'with s'
for scene in "$@"; do
  echo "$(basename "$scene") $(figures "$scene") $(figures "$scene" --reinsert)"
done | awk '
  { e = $6 / $2; r = $7 / $3; p = $8 / $4; n++
    estimated += log(e); real += log(r); pruned += log(p)
    printf "%-32s %10.3f %8.3f %8.3f %9.3f %9.3f\n", $1, e, r, p, $5, $9 }
  END { printf "%-32s %10.3f %8.3f %8.3f\n", "geometric mean", exp(estimated / n), exp(real / n), exp(pruned / n) }'
