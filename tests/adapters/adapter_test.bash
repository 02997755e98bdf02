# What the tests of both engines share: a small sweep in a folder with a difficult name, what it gives in one process, and checks.
failures=0 checks=0
fail() { printf 'FAILED: %s\n' "$1"; failures=$((failures + 1)); }

# expect CODE TEXT DESCRIPTION COMMAND...: the exit code, and a text in what is printed
expect() {
  local code=$1 text=$2 what=$3 output got
  shift 3
  output=$("$@" 2>&1)
  got=$?
  checks=$((checks + 1))
  [ "$got" -eq "$code" ] || fail "$what: exit code $got instead of $code; $output"
  case "$output" in *"$text"*) ;; *) fail "$what: \"$text\" is not in: $output" ;; esac
}
holds() { checks=$((checks + 1)); "${@:2}" >/dev/null 2>&1 || fail "$1"; }

# make_study FILE GENERATORS: 2 pipelines, 2 numbers of generators, 6 seeds
make_study() {
  cat >"$1" <<STUDY
{
  "cordon": 1,
  "title": "a \$(touch broken) sweep",
  "system": {
    "type": "lti",
    "A": [[0.9, 0.1], [0, 0.8]], "C": [[1, 0]],
    "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
    "W": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
    "V": {"type": "box", "lower": [-0.1], "upper": [0.1]}
  },
  "data": {"simulate": {"steps": 10}},
  "pipelines": [
    {"name": "zonotopes", "backend": "zonotope", "observer": "prediction_correction"},
    {"name": "boxes", "backend": "interval", "observer": "prediction_correction"}
  ],
  "metrics": ["radius"],
  "sweep": [
    {"name": "generators", "path": "/pipelines/*/observer/max_generators", "values": $2},
    {"name": "seed", "path": "/data/simulate/seed", "range": [1, 6]}
  ]
}
STUDY
}

# same_results DIR: those of the one process, but for times
same_results() {
  local file
  for file in results.json points.csv summary.csv; do holds "$1/$file is that of one process" cmp "$1/$file" "one process/$file"; done
}

# finish NAME
finish() {
  printf '%s: %d checks, %d failures\n' "$1" "$checks" "$failures"
  [ "$failures" -eq 0 ]
}
