#!/usr/bin/env bash
# every_build.sh CAVUM SOURCE_DIR BUILD_DIR REPLAYER...
# Records a simulated candidate with CAVUM, drawn out of three by CAVUM_TEST_SEED (one of the three sits under the set that cuts by pressure), takes the
# recorded exams in tests/replay/sessions too, and lets every REPLAYER (one for each compiler and optimisation level) replay and regrade them all. All
# must verify and print the same lines. With CAVUM_DEEP all three sit, and a replayer for arm64 is built, too.
set -euo pipefail
cavum=$1 source=$2 build=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export CAVUM_HOME=$work/home
sittings=(perforator:class_1:consistent novice:slot:consistent expert:slot:clinical)
if [ -z "${CAVUM_DEEP:-}" ]; then
  sittings=("${sittings[${CAVUM_TEST_SEED:-0} % 3]}")
  echo "drawn: ${sittings[0]}"
fi
for sitting in "${sittings[@]}"; do
  IFS=: read -r operator task model <<<"$sitting"
  "$cavum" exam "$source/data/scenarios/$task.toml" --candidate replay --operator "$operator" --model "$model" --out "$work/$operator.cavum" --quiet >/dev/null
done
cp "$source"/tests/replay/sessions/*.cavum "$work/"
replayers=("$@")
if [ -n "${CAVUM_DEEP:-}" ]; then
  mkdir -p "$build/arm64"
  replayers+=("$("$source/tests/replay/arm64.sh" "$source" "$build/arm64")")
fi
cd "$work"
failed=0
for replayer in "${replayers[@]}"; do
  echo "== ${replayer##*/build/}"
  "$replayer" ./*.cavum >"$work/lines" || { failed=1; cat "$work/lines"; }
  if [ -f "$work/first" ]; then
    diff "$work/first" "$work/lines" || { echo "this build gives other bits"; failed=1; }
  else
    cp "$work/lines" "$work/first"
    cat "$work/first"
  fi
done
exit $failed
