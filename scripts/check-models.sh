#!/usr/bin/env bash
# Loads every file of a folder of models (Debian's assimp-testmodels) with the program, under limits of time and memory:
# each is loaded or refused with an error. Writes the page docs/models.md to standard output; fails where a file
# crashes the program, hangs it, or is refused without a word.
# `make models` writes docs/models.md with it. Use: scripts/check-models.sh PROGRAM [FOLDER [SECONDS [MEMORY_KIB|unlimited]]]; exits with 77 where there are no models.
set -euo pipefail
export LC_ALL=C
program=$(realpath "$1") folder=${2:-/usr/share/assimp/models} seconds=${3:-20} memory=${4:-4194304}
if [ ! -d "$folder" ]; then
  echo "skipped: $folder is not there (Debian package assimp-testmodels)" >&2
  exit 77
fi
cd "$folder"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

check() {  # FILE -> "ENDING<tab>OUTCOME<tab>FILE<tab>MESSAGE"
  local code=0 error ending
  ending=$(tr '[:upper:]' '[:lower:]' <<<"${1##*.}")
  error=$(ulimit -v "$memory"; ulimit -c 0; timeout "$seconds" "$program" scene info "$1" 2>&1 >/dev/null) || code=$?
  error=$(tr '\n\t' '  ' <<<"$error" | sed 's/ *$//')
  if [ $code = 0 ]; then printf '%s\tloaded\t%s\t\n' "$ending" "$1"
  elif [ $code = 1 ] && [[ $error == 'raygrain: error: '* ]]; then
    if [[ $error == *': unknown mesh format '* || $error == *'has no ending that tells its format'* ]]
    then printf '%s\tother\t%s\t\n' "$ending" "$1"
    else printf '%s\trefused\t%s\t%s\n' "$ending" "$1" "${error#raygrain: error: "$1"}"
    fi
  else printf '%s\tBAD\t%s\texit code %s: %s\n' "$ending" "$1" "$code" "$error"
  fi
}

find . -type f | sed 's|^\./||' | sort | while IFS= read -r file; do check "$file"; done >"$work/rows"
cat <<END
# Models of other people

Every file of Debian's package \`assimp-testmodels\`, loaded with \`raygrain scene info\` under limits of $seconds seconds and
$((memory / 1024)) MiB: working models, broken ones and hostile ones. Made by \`make models\`.

END
awk -F'\t' '
  $2 == "other" { others++; next }
  { endings[$1]; count[$1, $2]++; total[$2]++ }
  END {
    printf "%d files loaded, %d refused with an error, %d crashed, hung or said nothing; %d files in the folder are no models.\n\n",
           total["loaded"], total["refused"], total["BAD"], others
    print "| format | loaded | refused | bad |\n|---|---|---|---|"
    n = asorti_portable()
    for (i = 1; i <= n; i++)
      printf "| %s | %d | %d | %d |\n", sorted[i], count[sorted[i], "loaded"], count[sorted[i], "refused"], count[sorted[i], "BAD"]
  }
  function asorti_portable(   e, n, i, j, t) {
    for (e in endings) sorted[++n] = e
    for (i = 2; i <= n; i++) { t = sorted[i]; for (j = i - 1; j > 0 && sorted[j] > t; j--) sorted[j + 1] = sorted[j]; sorted[j + 1] = t }
    return n
  }' "$work/rows"
printf '\n| refused file | reason |\n|---|---|\n'
awk -F'\t' '$2 == "refused" || $2 == "BAD" { gsub(/\|/, "\\|", $4); sub(/^: */, "", $4); printf "| %s | %s |\n", $3, $4 }' "$work/rows"
! grep -q "$(printf '\tBAD\t')" "$work/rows"
