#!/usr/bin/env bash
# Every public header has its page and every path that ARCHITECTURE.md names exists; links between the documents lead somewhere.
set -euo pipefail
cd "$1"
failed=0
complain() { echo "$*" >&2; failed=1; }

for header in include/raygrain/*.h; do
  page=docs/$(basename "$header" .h).md
  [ "$(basename "$header")" = raygrain.h ] || [ -f "$page" ] || complain "$header has no $page"
done
while IFS= read -r path; do
  [ -e "$path" ] || complain "ARCHITECTURE.md names $path, which is not there"
done < <(grep -oE '`(include|src|cli|tests|scripts|docs|examples|cmake|bench)/[A-Za-z0-9_./-]*`' ARCHITECTURE.md | tr -d '`' | sort -u)
for page in README.md ARCHITECTURE.md CHANGELOG.md TESTING.md docs/*.md; do
  while IFS= read -r target; do
    [ -e "$(dirname "$page")/$target" ] || complain "$page links to $target, which is not there"
  done < <(awk '/^```/ { code = !code } !code' "$page" | grep -oE '\]\([^)#]+' | sed 's/^](//' | grep -vE '^https?:' || true)
done
for page in README.md ARCHITECTURE.md CHANGELOG.md TESTING.md docs/*.md; do
  ! grep -nE '^(<<<<<<<|>>>>>>>) ' "$page" || complain "$page holds both sides of a merge"
done
for folder in src/*/; do
  grep -q "src/$(basename "$folder")" ARCHITECTURE.md || complain "ARCHITECTURE.md does not mention $folder"
done
exit $failed
