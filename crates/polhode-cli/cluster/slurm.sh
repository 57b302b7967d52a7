#!/usr/bin/env bash
# Shares of an ensemble run by a Slurm array on this machine give the bits of one run, also after a share was lost:
#   bash crates/polhode-cli/cluster/slurm.sh [target/release/polhode]
# Starts a controller, a node and an authentication service of its own on the loopback, and ends them. Skipped where Slurm is not
# installed (Debian: slurm-wlm and munge) and without root, which Slurm's node daemon needs.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
for program in munged slurmctld slurmd sbatch scontrol; do
  command -v "$program" > /dev/null || skip "$program is not installed (Debian: slurm-wlm and munge)"
done
[ "$(id -u)" = 0 ] || skip "the daemon of a Slurm node needs root"
slurmctld -V

pids=()
finish() {
  # the node first, so that it takes leave of its controller
  for ((k = ${#pids[@]} - 1; k >= 0; k--)); do
    kill "${pids[k]}" 2> /dev/null && wait "${pids[k]}" 2> /dev/null
  done
  rm -rf "$folder"
}
trap finish EXIT

slurm=$folder/slurm
mkdir -p "$slurm/state" "$slurm/spool"
dd if=/dev/urandom of="$slurm/munge.key" bs=1024 count=1 status=none
chmod 400 "$slurm/munge.key"
munged --foreground --force --key-file="$slurm/munge.key" --socket="$slurm/munge.socket" \
  --pid-file="$slurm/munge.pid" --log-file="$slurm/munge.log" --seed-file="$slurm/munge.seed" > "$slurm/munge.out" 2>&1 &
pids+=($!)

# two runs on one machine do not meet
port=$((20000 + 2 * ($$ % 10000)))
export SLURM_CONF=$slurm/slurm.conf
cat > "$SLURM_CONF" << CONF
ClusterName=loopback
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$slurm/munge.socket
CredType=cred/munge
StateSaveLocation=$slurm/state
SlurmdSpoolDir=$slurm/spool
SlurmctldPidFile=$slurm/slurmctld.pid
SlurmdPidFile=$slurm/slurmd.pid
SlurmctldLogFile=$slurm/slurmctld.log
SlurmdLogFile=$slurm/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
MpiDefault=none
ReturnToService=2
NodeName=node NodeHostname=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=node Default=YES MaxTime=INFINITE State=UP
CONF
slurmctld -D > /dev/null 2>&1 &
pids+=($!)
slurmd -D -N node > /dev/null 2>&1 &
pids+=($!)

for _ in $(seq 60); do
  if scontrol show node node 2> /dev/null | grep -q "State=IDLE"; then break; fi
  sleep 1
done
if ! sinfo --noheader --format="%n: %c processors, %t" 2> /dev/null; then
  tail -n 20 "$slurm"/*.log
  exit 1
fi

whole
submit() {
  sbatch --wait --time=5 --array=1-4 --export=ALL --chdir="$folder" --output="$folder/task-%a.log" \
    "$root/crates/polhode-cli/cluster/job.sh" "$folder/spec.toml" "$folder/slurm-run"
  cat "$folder"/task-*.log
}
submit
echo "-- share 3 is lost, and the same array is submitted again"
rm -rf "$folder/slurm-run/shards/3-of-4"
submit
compare "$folder/slurm-run"
