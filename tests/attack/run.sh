#!/bin/sh
# All attacks with CAVUM_DEEP set, else the share in twenty-four that the seed chooses.
set -eu
share=0/1
[ -n "${CAVUM_DEEP:-}" ] || share=$((${CAVUM_TEST_SEED:-0} % 24))/24
export CAVUM_DATA="$3"
exec "$1" "$(dirname "$0")/run_attacks.py" --cavum "$2" --data "$3" --share "$share"
