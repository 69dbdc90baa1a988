#!/usr/bin/env bash
# memory.sh CAVUM [MINUTES]: what the station holds in memory while the mouse's hand drills to and fro in the lower molar and the view turns, minute by
# minute, and at the end how much it grew after the first. Needs Xvfb.
set -euo pipefail
cavum=$1
minutes=${2:-10}
here=$(cd "$(dirname "$0")/../../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
{
  printf 'type M1\ngo device-check\nsleep 1\nkey space 0.6\ngo briefing\nkey enter\nwait exam\nhold space\nhold pagedown\nuntil 4\nrelease pagedown\nhold d\n'
  for ((m = 1; m <= minutes; ++m)); do
    for ((s = 6; s < 60; s += 6)); do
      printf 'key %s 0.4\nuntil %d\n' "$([ $((s / 6 % 2)) = 1 ] && echo left || echo right)" $((60 * m - 60 + s))
    done
    printf 'key pagedown 0.3\nuntil %d\nmemory minute-%d\n' $((60 * m)) "$m"
  done
  printf 'release d\nrelease space\nkey escape\nsleep 0.5\nkey enter\nwait result\nkey enter\n'
} >"$work/script"
export CAVUM_HOME=$work/home
xvfb-run -a "$cavum" station "$here/data/scenarios/class_1.toml" --device mouse --extra-time-s $((60 * minutes)) --width 640 --height 480 \
  --out "$work/s.cavum" --script "$work/script" | tee "$work/said"
"$cavum" grade "$work/s.cavum" --json | sed -n 's/.*"removed_mm3": *\([0-9.]*\).*/removed: \1 mm3/p' | head -1
awk '/^minute-/ { if (first == "") first = $2; last = $2; n++ } END { if (n == 0) exit 1; printf "after the first minute: %+.1f MB in %d minutes\n", last - first, n - 1 }' \
  "$work/said"
echo "load: $(cut -d' ' -f1-3 /proc/loadavg)"
