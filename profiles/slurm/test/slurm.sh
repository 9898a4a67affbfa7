# A real Slurm of one node on this machine, all of it in one folder. For Debian, as root.
# Source it: node_size, start_slurm FOLDER CPUS MEMORY_MB, stop_slurm FOLDER.

# CPUs and memory in MB that the node may have: the processors that this process may use
# and nine tenths of the free memory, with as much for each CPU as a job of ours asks for.
node_size() { # MB a job, file like /proc/meminfo
  local memory cpus
  memory=$(awk '$1 == "MemAvailable:" { print int($2 / 1024 * 0.9) }' "$2")
  cpus=$(nproc)
  [ "$((memory / $1))" -ge "$cpus" ] || cpus=$((memory / $1))
  echo "$cpus $memory"
}

start_slurm() {
  local folder=$1 cpus=$2 memory=$3 host
  host=$(hostname -s)
  mkdir -p "$folder/state" "$folder/spool" "$folder/munge"
  dd if=/dev/urandom of="$folder/munge/key" bs=1 count=1024 status=none
  chown -R munge:munge "$folder/munge"
  chmod 755 "$folder" "$folder/munge"
  chmod 400 "$folder/munge/key"
  cat > "$folder/slurm.conf" <<CONF
ClusterName=hystbench
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
# A job that has ended stays in squeue's sight, since there is no sacct here.
MinJobAge=600
SchedulerParameters=sched_interval=1,batch_sched_delay=0
NodeName=$host NodeAddr=127.0.0.1 CPUs=$cpus RealMemory=$memory
PartitionName=main Nodes=$host Default=YES State=UP
CONF
  # With SLURM_CONF alone the inner srun finds no configuration.
  mkdir -p /etc/slurm
  ln -sf "$folder/slurm.conf" /etc/slurm/slurm.conf
  # munged runs as its own user, whose key and folders these are.
  runuser -u munge -- munged --force --key-file="$folder/munge/key" \
    --socket="$folder/munge/socket" --pid-file="$folder/munge/pid" \
    --log-file="$folder/munge/log" --seed-file="$folder/munge/seed"
  setsid slurmctld -i
  setsid slurmd
  for _ in $(seq 60); do
    [ "$(sinfo --noheader --format=%T 2>/dev/null)" = idle ] && return 0
    sleep 1
  done
  echo "Slurm's node did not become idle; see $folder/*.log" >&2
  return 1
}

stop_slurm() {
  local folder=$1 file daemon
  for file in slurmd.pid slurmctld.pid munge/pid; do
    [ -s "$folder/$file" ] || continue
    daemon=$(cat "$folder/$file")
    kill "$daemon" || continue
    # Until it has ended it writes into the folder.
    while kill -0 "$daemon" 2> /dev/null; do sleep 0.2; done
  done
  [ "$(readlink /etc/slurm/slurm.conf)" != "$folder/slurm.conf" ] || rm /etc/slurm/slurm.conf
}
