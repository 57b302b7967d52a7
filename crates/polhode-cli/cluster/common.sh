# What the tests of launchers share: the program, a folder of their own, a specification and the run to compare with.
# Sourced by them with the path of the program as first argument.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)

skip() {
  echo "skipped: $*"
  exit 0
}

POLHODE=$(realpath "${1:-$root/target/release/polhode}")
[ -x "$POLHODE" ] || skip "no program at $POLHODE; build it with cargo build --release, or name it"
export POLHODE
folder=$(mktemp -d)
chmod 755 "$folder"

# One run of all members, in $folder/whole.
whole() {
  sed 's/^members = .*/members = 4000/' "$root/examples/ensemble.toml" > "$folder/spec.toml"
  "$POLHODE" ensemble "$folder/spec.toml" --out "$folder/whole" --shard 1/1
}

# Gathers the shards of a folder and compares every file with the run of all members.
compare() {
  "$POLHODE" gather "$1"
  for file in "$folder"/whole/*; do
    cmp "$file" "$1/$(basename "$file")"
  done
  echo "$(ls "$1/shards" | wc -l) shards, $(ls "$folder/whole" | wc -l) files: the bits of the run of all members"
}
