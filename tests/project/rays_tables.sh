#!/usr/bin/env bash
# The tables of rays with structure: rays_tables.sh SOURCE FOLDER. From made-up figures come the expected tables, and documents are rewritten
# between their marks and nowhere else. Skipped (77) without Python.
set -euo pipefail
source=$1 folder=$2
command -v python3 >/dev/null || { echo "skipped: python3 is not installed"; exit 77; }
script=$source/scripts/rays_tables.py given=$source/tests/project/rays_tables
rm -rf "$folder" && mkdir -p "$folder" && cd "$folder"
fail() { echo "$*" >&2; exit 1; }

python3 "$script" "$given/figures.json" >tables.md
diff -u "$given/expected.md" tables.md || fail "other tables than expected"

# Marks without their tables.
outside() { awk '/^<!-- \/rays:/ { inside = 0 } !inside; /^<!-- rays:/ { inside = 1 }' "$1"; }
for page in docs/performance-rays.md README.md; do
  cp "$source/$page" page.md
  python3 "$script" "$given/figures.json" --into page.md
  diff <(outside "$source/$page") <(outside page.md) && [ -z "$(tail -c 1 page.md)" ] || fail "$page: changed beside its tables"
  for name in $(grep -oP '(?<=<!-- rays:)[\w-]+(?= -->)' page.md); do
    block="/<!-- rays:$name -->/,/<!-- \/rays:$name -->/p"
    diff <(sed -n "$block" tables.md) <(sed -n "$block" page.md) || fail "$page: not the table $name"
  done
done
grep -q 'rays:batches' "$source/docs/performance-rays.md" || fail "docs/performance-rays.md has no tables"

for text in '<!-- rays:nothing --><!-- /rays:nothing -->' '<!-- rays:about -->' '<!-- /rays:about --><!-- rays:about -->'; do
  echo "$text" >bad.md
  ! python3 "$script" "$given/figures.json" --into bad.md 2>error.txt || fail "took $text"
  [ "$(cat bad.md)" = "$text" ] || fail "changed $text"
done
echo '{"environment": {}, "rows": []}' >empty.json
! python3 "$script" empty.json >tables.md 2>error.txt || fail "took figures without rows"
