#!/usr/bin/env bash
# one_arrow_up.sh: for each room in turn a house in which one include of that room looks up to the next, and in a second
# one down: walls.sh must refuse the first, name it, and pass the second.
set -euo pipefail
walls=$(cd "$(dirname "$0")" && pwd)/walls.sh
house=$(mktemp -d)
trap 'rm -rf "$house"' EXIT
tried=0
while read -r below above; do
    mkdir -p "$house/$below" "$house/$above"
    printf '#include "%s/above.h"\n' "$above" >"$house/$below/looks.h"
    if said=$("$walls" "$house"); then echo "$below may look up to $above: $said" && exit 1; fi
    [[ $said == *"$below/looks.h:1: $below may not look up to \"$above/above.h\""* ]] || { echo "$said" && exit 1; }
    rm "$house/$below/looks.h"
    printf '#include "%s/below.h"\n' "$below" >"$house/$above/looks.h"
    said=$("$walls" "$house") || { echo "$above may not look down to $below: $said" && exit 1; }
    rm "$house/$above/looks.h"
    tried=$((tried + 1))
done < <("$walls" --rooms)
echo "$tried arrows up refused, as many down let through"
((tried > 0))
