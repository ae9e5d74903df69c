# SPDX-License-Identifier: Apache-2.0
# Images go to the device by palpate and by dfu-util, and come back the same. PRODUCT: vendor and product ID; DFU files are for them.
. ./lib.sh
product=${PRODUCT:-1209:0001}
device_up --flash "$scratch/flash" --slot-kib 512 --erase-ms 45 --rate 1000

# read_back NAME SLOT IMAGE
read_back() {
  rm -f "$scratch/back"
  dfu-util -d "$product" -a "$2" -U "$scratch/back" >"$scratch/said" 2>&1
  fact "$1" "$(cmp "$scratch/back" "$3" >/dev/null 2>&1 && echo same || echo different)"
}
letter() { sed -n 's/.*Slot \([AB]\) .*/\1/p' "$scratch/said" | tr AB 01; }

status flash palpate flash ellipsoid.palp --device "$device" --verify --quiet
slot=$(letter)
read_back flash_back "$slot" ellipsoid.palp

# While the loop renders the device is the loop's.
json beside "${render[@]}" --rate 1000 --seconds 1.5 >"$scratch/beside" & run=$!
sleep 1
status flash_beside palpate flash small.palp --device "$device" --quiet
wait $run
cat "$scratch/beside"

other=$((1 - slot))
status dfu_other_product dfu-util -d "$product" -a "$other" -D other.dfu
status dfu dfu-util -d "$product" -a "$other" -D small.dfu
read_back dfu_back "$other" small.palp
read_back flash_still_there "$slot" ellipsoid.palp
