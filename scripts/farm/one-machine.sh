#!/usr/bin/env bash
# A Slurm cluster of two nodes with one CPU each, all on this machine, to try things out: it listens on the loopback
# interface only, keeps everything in one folder, and needs no systemd.
#
#   scripts/farm/one-machine.sh up       starts it, and prints how to use it
#   scripts/farm/one-machine.sh down     stops it, with all that runs on it
#
# FARM names the folder (default: backlight-farm in the folder for temporary files), FARM_PORT the first of three ports (default 26817).
# Packages: scripts/install.sh farm
set -euo pipefail
FARM=${FARM:-${TMPDIR:-/tmp}/backlight-farm} FARM_PORT=${FARM_PORT:-26817}
PATH=$PATH:/usr/sbin:/sbin
host=$(hostname -s)
user=$(id -un)
export SLURM_CONF=$FARM/slurm.conf

pid_of() { cat "$FARM/run/$1.pid" 2>/dev/null; }

# Whether the process is there, and is not another that has got its number.
is_running() { [[ -n ${1:-} && $(cat "/proc/$1/comm" 2>/dev/null) == "$2" ]]; }

write_configuration() {
  cat >"$SLURM_CONF" <<C
ClusterName=backlight
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$FARM/run/munge.sock,cred_expire=5
CredType=cred/munge
SlurmctldPort=$FARM_PORT
SlurmctldPidFile=$FARM/run/slurmctld.pid
SlurmdPidFile=$FARM/run/slurmd.%n.pid
SlurmctldLogFile=$FARM/log/slurmctld.log
SlurmdLogFile=$FARM/log/slurmd.%n.log
StateSaveLocation=$FARM/ctld
SlurmdSpoolDir=$FARM/spool/%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,sched_min_interval=0,bf_interval=1,batch_sched_delay=0
ReturnToService=2
SlurmctldTimeout=30
SlurmdTimeout=5
KillWait=5
MinJobAge=600
MaxArraySize=10001
MaxJobCount=20000
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc=$FARM/log/jobs.txt
SlurmdParameters=config_overrides
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((FARM_PORT + 1)) CPUs=1 RealMemory=4000 State=UNKNOWN
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((FARM_PORT + 2)) CPUs=1 RealMemory=4000 State=UNKNOWN
PartitionName=render Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
C
}

wait_for_nodes() {
  local i
  for ((i = 0; i < 150; i++)); do
    [[ $(sinfo -h -N -t idle -o %N 2>/dev/null | sort -u | wc -l) == 2 ]] && return
    sleep 0.2
  done
  echo "scripts/farm/one-machine.sh: the nodes did not come up; the logs are in $FARM/log" >&2
  tail -n 5 "$FARM"/log/*.log >&2
  return 1
}

up() {
  if is_running "$(pid_of slurmctld)" slurmctld; then
    echo "scripts/farm/one-machine.sh: it is up already in $FARM" >&2
    exit 1
  fi
  mkdir -p "$FARM"/{munge,ctld,spool,log,run}
  chmod 0755 "$FARM" "$FARM/run"
  chmod 0700 "$FARM/munge"
  [[ -f $FARM/munge/key ]] || (umask 077; head -c 1024 /dev/urandom >"$FARM/munge/key")
  munged --key-file="$FARM/munge/key" --socket="$FARM/run/munge.sock" --pid-file="$FARM/run/munged.pid" \
    --log-file="$FARM/munge/munged.log" --seed-file="$FARM/munge/seed" --num-threads=2
  write_configuration
  slurmctld -i -c # -c: from a clean state
  slurmd -N n1
  slurmd -N n2
  wait_for_nodes
  sinfo -N -l
  echo "export SLURM_CONF=$SLURM_CONF"
}

down() {
  [[ -d $FARM/run ]] || return 0
  if is_running "$(pid_of slurmctld)" slurmctld; then
    scancel --user="$user" 2>/dev/null || true
    local i
    for ((i = 0; i < 40; i++)); do [[ -z $(squeue -h 2>/dev/null) ]] && break; sleep 0.2; done
  fi
  local pair pid
  for pair in slurmd.n1:slurmd slurmd.n2:slurmd slurmctld:slurmctld munged:munged; do
    pid=$(pid_of "${pair%:*}") || true
    is_running "$pid" "${pair#*:}" || continue
    kill "$pid"
    for ((i = 0; i < 50; i++)); do is_running "$pid" "${pair#*:}" || break; sleep 0.1; done
    is_running "$pid" "${pair#*:}" && kill -9 "$pid"
  done
  rm -f "$FARM"/run/*.pid
}

case ${1:-} in
  up) up ;;
  down) down ;;
  -h | --help) sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//p}' "$0" ;;
  *) sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//p}' "$0" >&2; exit 2 ;;
esac
