#!/usr/bin/env bash
# cluster_test.sh CAVUM SESSIONS_FOLDER [COUNT]: COUNT sessions (240 unless told; copies of those in the folder) are verified by threads, by shards that are
# merged, and by a Slurm cluster of two nodes, once whole and once with a slurmd that is killed in the middle. All lines must be the same bytes.
# Exit: 0 they are, 77 Slurm cannot run here, 1 they are not.
set -euo pipefail
cavum=$(realpath "${1:?usage: cluster_test.sh CAVUM SESSIONS_FOLDER [COUNT]}")
sessions=$(realpath "$2")
count=${3:-240}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d /tmp/cavum-cluster-XXXXXX)
end() { "$here/cluster.sh" down "$work/cluster"; rm -rf "$work"; }
trap end EXIT
fail() { echo "cluster_test: $1" >&2; exit 1; }

mkdir "$work/s"
mapfile -t known < <(ls "$sessions"/*.cavum)
for ((i = 0; i < count; i++)); do cp "${known[i % ${#known[@]}]}" "$work/s/$(printf %05d $i).cavum"; done

"$cavum" verify-all "$work/s" --out "$work/threads" | sed 's/^/threads: /'
[ "$(wc -l <"$work/threads")" -eq "$count" ] || fail "threads gave $(wc -l <"$work/threads") lines of $count"

for k in 1 2 3; do "$cavum" verify-all "$work/s" --shard $k/3 --out "$work/$k.part" >/dev/null; done
"$cavum" verify-all "$work/s" --merge "$work/1.part" "$work/3.part" --out "$work/two" >/dev/null 2>"$work/said" && fail "a part that is missing went unnoticed"
grep -q "$(((count + 1) / 3)) .*$count .* 2/3" "$work/said" || fail "the part that is missing is not named"
"$cavum" verify-all "$work/s" --merge "$work"/[123].part --out "$work/merged" >/dev/null
cmp "$work/threads" "$work/merged" || fail "three shards give other lines"
echo "three shards: the same bytes"

# a ledger of which one recording is gone and another one was exchanged: all makers say so, and give the same lines
export CAVUM_HOME=$work/home
"$cavum" ledger init "$work/L" --school Cluster >/dev/null
"$cavum" cohort simulate "$sessions/../block_cavity.toml" --ledger "$work/L" --sessions "$work/sat" --n 5 >/dev/null 2>&1
mapfile -t filed < <(ls "$work"/L/sessions/*.cavum)
rm "${filed[1]}"
cp "${filed[0]}" "${filed[3]}"
not_whole() { # NAME OPTIONS...
  local name=$1 code=0
  shift
  "$cavum" verify-all "$work/L" --out "$work/ledger-$name" "$@" >"$work/said" 2>/dev/null || code=$?
  ((code == 1)) && grep -qF "${filed[1]##*/}" "$work/said" && grep -qF "${filed[3]##*/}" "$work/said" || { cat "$work/said"; fail "$name: a damaged ledger is called whole"; }
  cmp "$work/ledger-threads" "$work/ledger-$name" || fail "$name: the ledger's lines are others"
}
not_whole threads
for k in 1 2; do "$cavum" verify-all "$work/L" --shard $k/2 --out "$work/L$k.part" >/dev/null; done
not_whole shards --merge "$work"/L[12].part
echo "a damaged ledger: threads and shards say so alike"

code=0
"$here/cluster.sh" up "$work/cluster" || code=$?
((code == 0)) || exit "$code"
export SLURM_CONF=$work/cluster/slurm.conf

"$cavum" verify-all "$work/s" --slurm --sessions-per-task 50 --work "$work/whole" --out "$work/slurm" | sed 's/^/two nodes: /'
cmp "$work/threads" "$work/slurm" || fail "the cluster gives other lines"
tasks=$(sed 's/\],*/\n/g' "$work/whole/blocks-1.json" | awk -F, '/[0-9]/ { print NF }' | sort -n | xargs)
awk -v count="$count" -v sizes="$tasks" 'BEGIN { n = split(sizes, of, " "); for (i in of) sum += of[i]
  exit !(sum == count && (n == 1 || of[1] >= 50) && of[n] - of[1] <= 1) }' || fail "tasks are uneven, or below 50 sessions: $tasks"

not_whole slurm --slurm --work "$work/ledger-work"
echo "a damaged ledger: the cluster says the same"

# the same with a node that dies: its daemon and what it runs
"$cavum" verify-all "$work/s" --slurm --sessions-per-task 50 --work "$work/broken" --out "$work/killed" >"$work/said" 2>&1 &
verb=$!
for _ in $(seq 600); do
  [ "$(cat "$work"/broken/parts/*.part 2>/dev/null | wc -l)" -ge $((count / 4)) ] && break
  kill -0 $verb 2>/dev/null || { cat "$work/said"; fail "it ended before a node could be killed"; }
  sleep 0.1
done
at=$(cat "$work"/broken/parts/*.part | wc -l)
((at < count)) || fail "it ended before a node could be killed"
kill -9 "$(cat "$work/cluster/slurmd-seat2.pid")"
for p in $(env -u SLURMD_NODENAME grep -lzxsF "SLURMD_NODENAME=seat2" /proc/[0-9]*/environ | cut -d/ -f3); do
  grep -qzxsF "SLURM_CONF=$SLURM_CONF" "/proc/$p/environ" && kill -9 "$p" 2>/dev/null || true
done
wait $verb || { cat "$work/said"; fail "with a dead node it does not end well"; }
sed 's/^/one node died: /' "$work/said"
cmp "$work/threads" "$work/killed" || fail "with a dead node the lines are others"
echo "slurmd of seat2 was killed after $at of $count lines: the same bytes"
