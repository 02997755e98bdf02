# A Slurm cluster of this machine alone, without systemd and without the machine's own configuration: start_cluster FOLDER,
# stop_cluster. Everything it writes is in FOLDER, its ports are free ones, and it is gone in the end.
cluster_pids=()

# Ports of the loopback interface that nobody listens to.
free_ports() {
  python3 - "$1" <<'PY'
import socket, sys
sockets = [socket.socket() for _ in range(int(sys.argv[1]))]
for s in sockets: s.bind(("127.0.0.1", 0))
print(" ".join(str(s.getsockname()[1]) for s in sockets))
PY
}

# until_true SECONDS COMMAND...
until_true() {
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    [ $SECONDS -lt $end ] || return 1
    sleep 0.2
  done
}

# spawn NAME COMMAND...: in the background, with a log of its own
spawn() {
  local name=$1
  shift
  "$@" >"$cluster/$name.out" 2>&1 </dev/null &
  cluster_pids+=($!)
}

start_cluster() {
  cluster=$1
  mkdir -p "$cluster/state" "$cluster/spool" "$cluster/munge"
  chmod 755 "$cluster"
  local user host ports
  user=$(id -un)
  host=$(hostname -s)
  read -r -a ports < <(free_ports 2)
  dd if=/dev/urandom of="$cluster/munge/key" bs=1 count=128 2>/dev/null
  chmod 700 "$cluster/munge"
  chmod 400 "$cluster/munge/key"
  cat >"$cluster/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$cluster/munge/socket
CredType=cred/munge
SlurmctldPort=${ports[0]}
SlurmdPort=${ports[1]}
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/slurmd.pid
SlurmctldLogFile=$cluster/slurmctld.log
SlurmdLogFile=$cluster/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=batch_sched_delay=0,sched_interval=1
MinJobAge=300
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
  printf 'CgroupPlugin=cgroup/v1\n' >"$cluster/cgroup.conf"
  export SLURM_CONF=$cluster/slurm.conf
  # The folder above belongs to whoever runs this: munged is told to accept that.
  spawn munged munged --foreground --force --key-file="$cluster/munge/key" --socket="$cluster/munge/socket" \
    --pid-file="$cluster/munge/pid" --seed-file="$cluster/munge/seed" --log-file="$cluster/munge/log"
  until_true 20 test -S "$cluster/munge/socket" || return 1
  chmod 711 "$cluster/munge"
  spawn slurmctld slurmctld -D -f "$SLURM_CONF"
  until_true 30 scontrol ping || return 1
  spawn slurmd slurmd -D -f "$SLURM_CONF"
  until_true 30 node_is_idle || return 1
}

node_is_idle() { [ "$(sinfo --noheader --format=%T)" = idle ]; }

# Ends what was started here, and the jobs.
stop_cluster() {
  scancel --quiet --user="$(id -un)" >/dev/null 2>&1
  local i
  for ((i = ${#cluster_pids[@]} - 1; i >= 0; --i)); do
    kill "${cluster_pids[i]}" 2>/dev/null
    wait "${cluster_pids[i]}" 2>/dev/null
  done
  cluster_pids=()
}
