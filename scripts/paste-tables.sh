#!/usr/bin/env bash
# Tables that a program printed, into a document: paste-tables.sh OUTPUT PAGE. What OUTPUT has between <!-- NAME --> and <!-- /NAME -->
# replaces what PAGE has there. A page without any of these marks, or without the end of one, is an error and stays as it is.
set -euo pipefail
output=$1 page=$2
fresh=$(mktemp)
trap 'rm -f "$fresh"' EXIT
awk '
  function name(line) { return substr(line, 6, length(line) - 9) }
  FNR == NR && /^<!-- [^\/].* -->$/ { key = name($0); known[key] = 1; next }
  FNR == NR && /^<!-- \/.* -->$/ { key = ""; next }
  FNR == NR { if (key != "") text[key] = text[key] $0 "\n"; next }
  open != "" && $0 == "<!-- /" open " -->" { open = "" }
  open != "" { next }
  { print }
  /^<!-- [^\/].* -->$/ && (name($0) in known) { open = name($0); printf "%s", text[open]; ++pasted }
  END { if (open != "" || !pasted) { print "no tables of this output belong there, or a mark has no end" > "/dev/stderr"; exit 1 } }
' "$output" "$page" >"$fresh"
cat "$fresh" >"$page"
