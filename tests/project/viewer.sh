#!/usr/bin/env bash
# The viewer's page in a browser: viewer.sh PROGRAM SOURCE FOLDER. Skipped (77) where its parts are not installed or built, which needs the network:
# `make viewer` builds them, `make viewer-test` tests large scenes, too.
set -euo pipefail
program=$1 source=$2 folder=$3
skip() { echo "skipped: $1"; exit 77; }

command -v node >/dev/null || skip "node is not installed (make viewer)"
[ -x "${CHROMIUM:-/usr/bin/chromium}" ] || skip "Chromium is not installed (make viewer-test)"
[ -d "$source/viewer/node_modules/playwright-core" ] || skip "the viewer's packages are not installed (make viewer)"
page=$(dirname "$program")/../share/raygrain/viewer.html
[ -f "$page" ] || skip "the viewer's page is not built (make viewer)"
newer=$(find "$source/viewer/src" "$source/viewer/index.html" -newer "$page" -print -quit)
[ -z "$newer" ] || skip "the viewer's page is older than $newer (make viewer)"
exec node "$source/viewer/test/viewer_test.mjs" "$program" "$folder" --quick
