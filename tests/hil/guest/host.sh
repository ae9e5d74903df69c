# SPDX-License-Identifier: Apache-2.0
# The host's program is stopped for 0.1 s, and killed: the device lets go by itself. The next run renders.
. ./lib.sh
device_up --rate 1000 --log

# strike NAME SIGNAL [SIGNAL]: sends the first one while a run renders, 0.1 s later the other
strike() {
  : >"$scratch/sim.log"
  "${render[@]}" --rate 1000 --seconds 1.5 >"$scratch/run" 2>&1 & local run=$!
  if [ "$BUS" = real ]; then sleep 1; else until_true grep -q "active, force" "$scratch/sim.log"; fi
  sleep 0.3
  mark "$1"
  kill "-$2" $run
  sleep 0.1
  let_go "$1"
  [ -z "${3:-}" ] || kill "-$3" $run
  wait $run
  echo "JSON $1 $? $(tr -d '\n' <"$scratch/run")"
  measure "$1_again" --rate 1000 --seconds 0.4
}
strike stopped STOP CONT
strike killed KILL
