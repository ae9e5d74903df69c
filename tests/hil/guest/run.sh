# SPDX-License-Identifier: Apache-2.0
# RATE, DURATION
. ./lib.sh
device_up
json devices palpate devices --json
hogs_on
measure run --rate "$RATE" --seconds "$DURATION"
hogs_off
tail -n 3 "$scratch/sim.log"
