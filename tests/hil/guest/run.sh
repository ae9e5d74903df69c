# SPDX-License-Identifier: Apache-2.0
# RATE, DURATION; CONTACTS: these have a rate of their own
. ./lib.sh
if [ -n "${CONTACTS:-}" ]; then
  sed "s/^rate_Hz.*/&\ncontact_rate_Hz = $CONTACTS.0/" "$scene" >served.toml
  render[2]=served.toml
fi
device_up
json devices palpate devices --json
measure_beside_hogs run --rate "$RATE" --seconds "$DURATION"
tail -n 3 "$scratch/sim.log"
