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
case " $* " in
  *" --help "* | *" -h "*) exec python3 "$here/plant.py" --help ;;
esac
taken=0
if [ -e watch.state ]; then
  taken=$(watch --quiet </dev/null | sed -n 's/.*"lines": \([0-9]*\).*/\1/p')
fi
python3 "$here/plant.py" --skip "$taken" "$@" |
  "$cordon" stream "$here/three_tanks.json" --pipeline supervision --checkpoint watch.state \
    --log watch.log &
stream=$!
# Who stops this script stops the stream, after the sample at hand.
trap 'kill -TERM $stream 2>/dev/null' TERM INT
status=0
wait $stream || status=$?
while kill -0 $stream 2>/dev/null; do  # a signal came
  status=0
  wait $stream || status=$?
done
exit $status
