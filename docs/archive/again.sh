#!/bin/sh
# Run an archived trial again with the code that made it:
#   sh docs/archive/again.sh COMMIT FOLDER TARGET...
# FOLDER is made; the results are in FOLDER/results.
set -eu
if [ $# -lt 3 ]; then
  echo "usage: sh docs/archive/again.sh COMMIT FOLDER TARGET..." >&2
  exit 2
fi
commit=$1
folder=$2
shift 2
git worktree add --detach "$folder" "$commit"
cd "$folder"
make .venv/ready
. .venv/bin/activate
exec snakemake --cores all "$@"
