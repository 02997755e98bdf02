#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Supervises the tanks, and goes on where it was stopped or killed: watch.sh [options of plant.py]
# The state is kept in watch.state, samples and alarms in watch.log.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
cordon=${CORDON:-cordon}
watch() {
  "$cordon" stream "$here/three_tanks.json" --pipeline supervision --checkpoint watch.state \
    --log watch.log "$@"
}
taken=0
if [ -e watch.state ]; then
  taken=$(watch --quiet </dev/null | sed -n 's/.*"lines": \([0-9]*\).*/\1/p')
fi
python3 "$here/plant.py" --skip "$taken" "$@" | watch
