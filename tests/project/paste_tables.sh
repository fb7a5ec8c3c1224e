#!/usr/bin/env bash
# Tables go where a page has their marks, and nowhere else: paste_tables.sh SOURCE FOLDER.
set -euo pipefail
source=$1 folder=$2
rm -rf "$folder" && mkdir -p "$folder" && cd "$folder"
fail() { echo "$*" >&2; exit 1; }
paste_tables() { "$source/scripts/paste-tables.sh" output.txt page.md; }

printf '%s\n' noise '<!-- a:one -->' '| 1 |' '| 2 |' '<!-- /a:one -->' noise '<!-- a:two -->' '| 3 |' '<!-- /a:two -->' >output.txt
printf '%s\n' before '<!-- a:one -->' old older '<!-- /a:one -->' between '<!-- b:other -->' kept '<!-- /b:other -->' after >page.md
printf '%s\n' before '<!-- a:one -->' '| 1 |' '| 2 |' '<!-- /a:one -->' between '<!-- b:other -->' kept '<!-- /b:other -->' after >expected.md
paste_tables && diff -u expected.md page.md || fail "another page than expected"
paste_tables && diff -u expected.md page.md || fail "not the same the second time"

for text in 'no marks' '<!-- a:one -->'; do
  echo "$text" >page.md
  ! paste_tables 2>/dev/null || fail "took a page of $text"
  [ "$(cat page.md)" = "$text" ] || fail "changed a page of $text"
done
for name in structures:pays structures:cells; do
  grep -qx "<!-- $name -->" "$source/docs/performance-rays.md" || fail "docs/performance-rays.md has no tables $name"
done
