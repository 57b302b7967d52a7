#!/usr/bin/env bash
# Shares of an ensemble started by Open MPI's mpirun on this machine give the bits of one run:
#   bash crates/polhode-cli/cluster/mpi.sh [target/release/polhode]
# Skipped where mpirun is not installed (Debian: openmpi-bin).
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
trap 'rm -rf "$folder"' EXIT
command -v mpirun > /dev/null || skip "mpirun is not installed (Debian: openmpi-bin)"
mpirun --version | head -1

whole
options=(--oversubscribe -n 4)
if [ "$(id -u)" = 0 ]; then options+=(--allow-run-as-root); fi
mpirun "${options[@]}" "$POLHODE" ensemble "$folder/spec.toml" --out "$folder/mpi" --threads 1
compare "$folder/mpi"
