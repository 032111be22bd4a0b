#!/usr/bin/env bash
# walls.sh ROOT: fails, and says where, if an #include crosses a wall of docs/architecture.md.
# walls.sh --rooms: each room with the one above it, a pair a line.
#
# Two tables are the whole drawing. Folders without a line (examples, bench, most tests) may use every house.
set -euo pipefail

# HOUSE: ITS ROOMS FROM THE GROUND UP | WHAT OF OTHER HOUSES ALL OF THEM MAY USE. A room may include its own files and
# those of rooms before it; '.' is the house's own folder. '!' refuses what a later word would allow.
houses=(
    'input: . toml | lang/text/near_name.h'
    'lang: abi text math ir ir/run ir/derive ir/bounds emit emit_c emit_glsl syntax format program lower check check/dimension . |'
    'libraries: . package | input lang/abi lang/text/near_name.h'
    'stdlib: . |'
    'jit: codegen engine picture texture fit ahead live check | !libraries/package libraries input lang stdlib'
    'runtime: process geometry hand surface surface/build contact texture scene force files render servo | input lang/abi lang/text/near_name.h'
    'device: . | !runtime/files runtime lang/abi lang/text/near_name.h'
    'api: . | include/haptel input/toml runtime device/device_factory.h lang/abi lang/parameter_value.h lang/text/near_name.h'
    'api/compiler: . | include/haptel api jit lang/abi'
    'tools: output arguments fit plot figures replay check library control explore sound commands . | input libraries lang stdlib jit runtime device bench'
    'tests/api: . | tests/support examples/chai3d'
    'tests/lang: . | tests/support tests/conformance/case.h tests/fuzz/random_source.h bench/elementary_truth.h runtime/servo/allocation_count.h lang stdlib'
    'tests/runtime: . | tests/support input/toml runtime lang/abi'
)

# Which folders alone may include a library.
declare -A home=(
    [llvm/]='jit' [llvm-c/]='jit' [libusb]='device' [toml++/]='input/toml'
    [assimp/]='runtime/files' [boost/]='lang/math device/inverse3 tests' [stb/]='jit/picture tests' [tiff]='jit/picture tests'
    [OpenEXR/]='jit/picture' [Imath/]='jit/picture' [CLI/]='tools' [cairo]='tools/plot'
    [haptel/]='include/haptel api examples/library examples/chai3d tests/api'
    [Eigen/]='jit/fit' [unsupported/Eigen/]='jit/fit'
    [zip.h]='libraries/package' [sha2.h]='libraries'
    [nlohmann/]='tools device/inverse3 tests bench' [sndfile]='device tests' [alsa/]='device' [lo/]='tools/control'
)

declare -A floor outside # by room: its place in its house; by house: what else it may use
for line in "${houses[@]}"; do
    house=${line%%:*} rooms=${line#*:} below='' height=0
    outside[$house]=${rooms#*|}
    for room in ${rooms%%|*}; do
        [[ $room == . ]] && room=$house || room=$house/$room
        floor[$room]=$((height += 1))
        [[ ${1:-} != --rooms || -z $below ]] || printf '%s %s\n' "$below" "$room"
        below=$room
    done
done
[[ ${1:-} != --rooms ]] || exit 0
cd "$1"

# Sets `house` and `room`: the longest known folders that hold the path; empty where it has none. A file of a house
# outside of its rooms is in none.
place() {
    local folder=$1
    house='' room=''
    while [[ $folder == */* ]]; do
        folder=${folder%/*}
        [[ -n $room || -z ${floor[$folder]:-} ]] || room=$folder
        [[ -z ${outside[$folder]+set} ]] || { house=$folder; return; }
    done
    room=''
}

house_allows() { # house_allows HOUSE HEADER
    local word
    for word in ${outside[$1]}; do
        [[ $2 != "${word#!}"* ]] || { [[ $word != !* ]]; return; }
    done
    return 1
}

library_allows() { # library_allows FILE HEADER
    local library folder
    for library in "${!home[@]}"; do
        [[ $2 == "$library"* ]] || continue
        for folder in ${home[$library]}; do
            [[ $1 != "$folder"/* ]] || return 0
        done
        return 1
    done
}

crossings=0
seen=0
crossed() {
    printf '%s:%s: %s\n' "$file" "$line" "$1"
    crossings=$((crossings + 1))
}

while IFS=: read -r file line directive; do
    seen=$((seen + 1))
    header=${directive#*[<\"]}
    header=${header%%[>\"]*}
    place "$file"
    from_house=$house from_room=$room
    place "$header"
    if [[ $directive != *\"* ]]; then
        library_allows "$file" "$header" || crossed "<$header> has its home elsewhere"
    elif [[ $header != */* ]]; then
        crossed "\"$header\" is not named from the root of the repository"
    elif [[ -n $from_house && -z $from_room ]]; then
        crossed "$file is in no room of $from_house"
    elif [[ -n $from_house && $house != "$from_house" ]]; then
        house_allows "$from_house" "$header" || crossed "$from_house may not include \"$header\""
    elif [[ -n $from_house ]] && ((${floor[$room]:-99} > ${floor[$from_room]})); then
        crossed "$from_room may not look up to \"$header\""
    fi
done < <(for folder in input libraries lang stdlib jit runtime device tools examples bench tests; do
    [[ ! -d $folder ]] || grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"]' "$folder" \
        --include='*.h' --include='*.c' --include='*.cpp' --include='*.def' --exclude-dir=broken_house || true
done)

printf '%s includes read, %s cross a wall\n' "$seen" "$crossings"
((seen > 0 && crossings == 0))
