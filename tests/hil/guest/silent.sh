# SPDX-License-Identifier: Apache-2.0
# The device stays on the bus but says nothing for 0.3 s.
. ./lib.sh
device_up --rate 1000 --log
measure silent --rate 1000 --seconds 1.2 >"$scratch/silent" & run=$!
until_true grep -q "active, force" "$scratch/sim.log"
sleep 0.3
kill -STOP "$simulator"
sleep 0.3
kill -CONT "$simulator"
wait $run
cat "$scratch/silent"
measure again --rate 1000 --seconds 0.4
