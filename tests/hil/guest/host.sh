# SPDX-License-Identifier: Apache-2.0
# The host's program is stopped for 0.1 s, and killed: the device lets go by itself. The next run renders. One with much memory to
# unlock ends: the device is told at once.
. ./lib.sh
device_up --rate 1000 --log

# strike NAME SIGNAL [SIGNAL]: sends the first one while a run renders, 0.1 s later the other
strike() {
  : >"$scratch/sim.log"
  "${render[@]}" --rate 1000 --seconds 1.5 >"$scratch/run" 2>&1 & local run=$!
  if [ "$BUS" = real ]; then sleep 1; else until_true grep -q "active, force" "$scratch/sim.log"; fi
  sleep 0.3
  mark
  kill "-$2" $run
  sleep 0.1
  let_go "$1"
  [ -z "${3:-}" ] || kill "-$3" $run
  wait $run
  echo "JSON $1 $? $(tr -d '\n' <"$scratch/run")"
  measure "$1_again" --rate 1000 --seconds 0.4
}
[ "$BUS" = real ] || {
  : >"$scratch/sim.log"
  sed 's/^nodes .*/nodes = 16384/' "$scene" >large.toml
  json ended palpate run large.toml --device "$device" --json --quiet --rate 1000 --seconds 0.4
  until_true grep -q "no force .* us after" "$scratch/sim.log"
  fact ended_after_us "$(sed -n 's/.*no force \([0-9]*\) us after.*/\1/p' "$scratch/sim.log" | head -n 1)"
}
strike stopped STOP CONT
strike killed KILL
