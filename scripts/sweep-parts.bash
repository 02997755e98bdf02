# Part of scripts/sweep-parallel and scripts/sweep-slurm: runs a sweep in parts, wherever each part
# runs. A folder DIR.parts beside the results holds the results of every part, what it printed, and
# two programs: run-part, which is what runs elsewhere, and merge-parts. All names are absolute: the
# folder is the same on all machines.

fail() {
  printf '%s: %s\n' "${0##*/}" "$1" >&2
  exit "${2:-2}"
}

# need PROGRAM PACKAGE
need() {
  command -v "$1" >/dev/null 2>&1 || fail "the program \"$1\" is missing; install $2"
}

# usage FILE: the comment at the beginning of a script.
usage() {
  sed -n '2,/^[^#]/{s/^# \{0,1\}//p}' "$1"
}

# is_count TEXT: a whole number from 1 to 9999?
is_count() {
  [[ $1 =~ ^[1-9][0-9]{0,3}$ ]]
}

# The program: CORDON, or the one that was built or installed with this script, or that of PATH.
find_cordon() {
  local beside
  beside=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
  for cordon in "${CORDON:-}" "$beside/../build/release/bin/cordon" "$beside/../bin/cordon" "$(command -v cordon || true)"; do
    if [ -n "$cordon" ] && [ -x "$cordon" ]; then
      cordon=$(realpath "$cordon")
      return
    fi
  done
  fail "the program \"cordon\" was not found; put it into PATH, or its name into the variable CORDON"
}

# prepare STUDY DIR SHARDS JOBS: checks the study and writes the two programs. JOBS may be a text
# for the shell of run-part.
prepare() {
  local study=$1 shards=$3 jobs=$4
  find_cordon
  [ -f "$study" ] || fail "there is no study $study"
  study=$(realpath "$study")
  out=$(realpath -m "$2")
  "$cordon" validate "$study" >/dev/null || exit $?
  parts=$out.parts
  mkdir -p "$parts" || fail "the folder $parts cannot be made"
  rm -f "$parts"/part-*.out "$parts"/part-*.err "$parts"/part-*.code
  {
    printf '#!/usr/bin/env bash\n# One part of a sweep: run-part NUMBER. What is finished is not run again.\nset -u\n'
    printf 'part=${1:-$SLURM_ARRAY_TASK_ID}\nshards=%s\ncd %q || exit 2\n' "$shards" "$parts"
    if [ -n "${CORDON_PLUGIN_PATH:-}" ]; then printf 'export CORDON_PLUGIN_PATH=%q\n' "$CORDON_PLUGIN_PATH"; fi
    printf '%q run %q --out "part-$part-of-$shards" --shard "$part/$shards" --resume %s' "$cordon" "$study" "$jobs"
    printf ' --no-report >"part-$part.out" 2>"part-$part.err"\n'
    printf 'code=$?\necho "$code" >"part-$part.code"\ncat "part-$part.err" >&2\n'
    printf '[ -s "part-$part.out" ] || exit $((code == 0 ? 1 : code))  # finished parts print their tables, whatever is in them\n'
  } >"$parts/run-part"
  {
    printf '#!/usr/bin/env bash\n# Joins the parts of a sweep if all of them are finished: merge-parts [LOG]\nset -u\n'
    printf 'shards=%s\ncd %q || exit 2\n[ $# -eq 0 ] || exec >"$1" 2>&1\n' "$shards" "$parts"
    cat <<'MERGE'
folders=()
for ((part = 1; part <= shards; ++part)); do
  folders+=("part-$part-of-$shards")
  [ -s "part-$part.out" ] && continue
  code=$(cat "part-$part.code" 2>/dev/null || echo 255)
  printf 'part %s of %s is not finished (exit code %s); the same command again goes on with it\n' "$part" "$shards" "$code" >&2
  [ -s "part-$part.err" ] && cat "part-$part.err" >&2
  exit $((code == 0 ? 1 : code))
done
MERGE
    printf '%q merge "${folders[@]}" --out %q\n' "$cordon" "$out"
  } >"$parts/merge-parts"
  chmod +x "$parts/run-part" "$parts/merge-parts"
}
