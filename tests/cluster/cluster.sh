#!/usr/bin/env bash
# cluster.sh up|down FOLDER: munge, slurmctld and two slurmd of one core each on this machine, all in FOLDER; the system's own configuration is neither
# read nor changed. `up` ends when both nodes are idle, `down` when no process and no file is left. Ports: 17321 to 17323, or from CAVUM_CLUSTER_PORT on.
# Exit: 0 done, 77 Slurm cannot run here, 1 it was begun and does not answer.
set -euo pipefail
folder=$(realpath -m "${2:?usage: cluster.sh up|down FOLDER}")
export SLURM_CONF=$folder/slurm.conf
port=${CAVUM_CLUSTER_PORT:-17321}

cannot() { echo "cluster: $1" >&2; exit 77; }

# processes of this cluster: its daemons, and the tasks that they began
ours() {
  local with_conf
  {
    env -u CAVUM_CLUSTER grep -lzxsF "CAVUM_CLUSTER=$folder" /proc/[0-9]*/environ
    mapfile -t with_conf < <(env -u SLURM_CONF grep -lzxsF "SLURM_CONF=$SLURM_CONF" /proc/[0-9]*/environ)
    ((!${#with_conf[@]})) || grep -lzs '^SLURM_JOB_ID=' "${with_conf[@]}"
  } | cut -d/ -f3 | sort -u || true
}

up() {
  local name
  for name in munged slurmctld slurmd sbatch squeue sinfo; do
    command -v "$name" >/dev/null || cannot "$name is not installed; on Debian: apt-get install slurmctld slurmd slurm-client munge"
  done
  [ "$(id -u)" -eq 0 ] || cannot "slurmd begins tasks as root only; run it as root, in a container for example"
  [ ! -e "$SLURM_CONF" ] || { echo "cluster: $folder holds a cluster; take it down first" >&2; exit 1; }
  mkdir -p "$folder"/{state,spool,log}
  chmod 755 "$folder"
  (umask 077 && head -c 128 /dev/urandom >"$folder/munge.key")
  local host
  host=$(hostname -s)
  cat >"$SLURM_CONF" <<EOF
ClusterName=cavum
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmctldPort=$port
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool/%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd-%n.pid
SlurmctldLogFile=$folder/log/slurmctld.log
SlurmdLogFile=$folder/log/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=2,batch_sched_delay=1
SlurmdParameters=config_overrides
SlurmdTimeout=10
JobRequeue=1
ReturnToService=2
NodeName=seat[1-2] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + 2))] CPUs=1 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
EOF
  export CAVUM_CLUSTER=$folder
  munged --key-file="$folder/munge.key" --socket="$folder/munge.socket" --log-file="$folder/log/munged.log" --pid-file="$folder/munged.pid" \
    --seed-file="$folder/munge.seed" --force >"$folder/log/munged.out" 2>&1 || { down; cannot "munged does not begin"; }
  slurmctld -c >"$folder/log/slurmctld.out" 2>&1 || { tail -5 "$folder"/log/slurmctld.* >&2; down; cannot "slurmctld does not begin"; }
  for name in seat1 seat2; do
    slurmd -N "$name" -c >"$folder/log/$name.out" 2>&1 || { tail -5 "$folder/log/$name.out" >&2; down; cannot "slurmd does not begin"; }
  done
  for _ in $(seq 60); do
    [ "$(sinfo --noheader --Node --format=%t 2>/dev/null | grep -c '^idle$')" -eq 2 ] && { echo "cluster: two nodes are idle; export SLURM_CONF=$SLURM_CONF"; return; }
    sleep 1
  done
  tail -5 "$folder"/log/*.log >&2
  down
  echo "cluster: its nodes do not answer" >&2
  exit 1
}

down() {
  [ ! -e "$SLURM_CONF" ] || scancel --user=root --quiet >/dev/null 2>&1 || true
  local pids
  for _ in 1 2 3 4 5 6; do
    mapfile -t pids < <(ours)
    ((${#pids[@]})) || break
    kill "${pids[@]}" 2>/dev/null || true
    sleep 1
  done
  mapfile -t pids < <(ours)
  ((${#pids[@]})) && kill -9 "${pids[@]}" 2>/dev/null || true
  rm -rf "$folder"
}

case "${1:-}" in
  up) up ;;
  down) down ;;
  *) echo "usage: cluster.sh up|down FOLDER" >&2; exit 2 ;;
esac
