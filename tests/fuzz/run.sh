#!/usr/bin/env bash
# Runs the built fuzzers one after the other: run.sh BUILD RUNS [NAME...]. Seeds and what is found new lie in BUILD/corpus, inputs that end a run in
# BUILD/findings. A run that takes more than 25 seconds, 1 GB in all or 300 MB at once is a finding, too.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$1 runs=$2
shift 2
(($#)) || set -- session recording replay settings ticket receipt candidates marks scenario motion tooth mesh explain results notes entries ledger volume
declare -A longest=([session]=24000 [recording]=600 [replay]=140 [settings]=3000 [ticket]=3000 [receipt]=4000 [candidates]=2000 [marks]=2000
  [scenario]=5000 [motion]=2000 [tooth]=1200 [mesh]=1500
  [explain]=2000 [results]=3000 [notes]=2000 [entries]=4000 [ledger]=400 [volume]=1200)
found=0
printf '%-11s %10s %8s %8s %9s %8s  %s\n' fuzzer runs seconds per_s coverage corpus findings
for name in "$@"; do
  fuzzer=$build/fuzz_$name corpus=$build/corpus/$name findings=$build/findings
  [ -x "$fuzzer" ] || { echo "fuzz: there is no fuzzer '$name'" >&2; exit 2; }
  mkdir -p "$corpus" "$findings"
  "$build/make_seeds" "$name" "$corpus"
  seeds=("$corpus")
  [ -d "$here/seeds/$name" ] && seeds+=("$here/seeds/$name")
  words=()
  [ -f "$here/dictionaries/$name.dict" ] && words=("-dict=$here/dictionaries/$name.dict")
  log=$findings/$name.log
  began=$SECONDS
  status=0
  ASAN_OPTIONS=malloc_context_size=2:quarantine_size_mb=1:thread_local_quarantine_size_kb=64 UBSAN_OPTIONS=print_stacktrace=1 nice -n 19 "$fuzzer" -runs="$runs" -max_len="${longest[$name]:-4096}" -timeout=25 -rss_limit_mb=1024 \
    -malloc_limit_mb=300 -print_final_stats=1 -entropic=0 -artifact_prefix="$findings/$name-" "${words[@]}" "${seeds[@]}" >"$log" 2>&1 || status=$?
  done_runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  seconds=$((SECONDS - began))
  last=$(grep -aE 'cov: [0-9]+ ft:' "$log" | tail -1)
  what=none
  if ((status)); then
    found=1
    what=$(grep -aE 'SUMMARY|ERROR: libFuzzer' "$log" | tail -1 || true)
    what="${what:-status $status} ($(sed -n 's/.*Test unit written to //p' "$log" | tail -1); $log)"
  fi
  printf '%-11s %10s %8s %8s %9s %8s  %s\n' "$name" "${done_runs:-?}" "$seconds" "$((${done_runs:-0} / (seconds > 0 ? seconds : 1)))" \
    "$(sed -n 's/.*cov: \([0-9]*\).*/\1/p' <<<"$last")" "$(sed -n 's/.*corp: \([0-9]*\).*/\1/p' <<<"$last")" "$what"
done
exit "$found"
