#!/usr/bin/env bash
# The main job on a built-in scene: the paper's heuristics compared for a sun over a procedural city.
set -euo pipefail
program=$1
out=$2
scene='procedural:city'
echo
echo "raygrain compare $scene --sun 1,-0.15,0.1 --rays 10000 --verify --out $out"
echo
"$program" compare "$scene" --sun 1,-0.15,0.1 --rays 10000 --verify --out "$out"
