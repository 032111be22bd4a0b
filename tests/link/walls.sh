#!/usr/bin/env bash
# walls.sh ROOT: fails, and says where, if an #include crosses a wall of docs/architecture.md.
#
# Two tables are the whole drawing. A folder's line holds for its subfolders unless those have a line of their own;
# folders without a line (tools, examples, bench, most tests) may use every layer.
set -euo pipefail
cd "$1"

# What a folder may include of the project: the first prefix that fits decides, ! refuses.
contract='lang/abi/abi.h lang/abi/evaluate.h lang/abi/texture_binding.h'
declare -A may_include=(
    [lang]='lang/'
    [stdlib]='stdlib/'
    [jit]='jit/ lang/ stdlib/'
    [runtime]="!runtime/files/ runtime/ $contract"
    [runtime/files]="runtime/ $contract"
    [device]="device/ !runtime/files/ runtime/ $contract"
    [tests/lang]='tests/support/ tests/lang/ tests/conformance/case.h lang/ stdlib/'
    [tests/runtime]="tests/support/ tests/runtime/ runtime/ $contract"
)

# Which folders alone may include a library.
declare -A home=(
    [llvm/]='jit' [llvm-c/]='jit' [libusb]='device' [embree]='runtime' [toml++/]='runtime/files'
    [assimp/]='runtime/files' [boost/]='lang tests' [stb/]='jit tests' [tiff]='jit tests' [OpenEXR/]='jit' [Imath/]='jit' [CLI/]='tools' [cairo]='tools' [nlohmann/]='tools tests bench'
)

# The longest folder with a line in may_include that holds the file, or nothing.
layer_of() {
    local folder=$1
    while [[ $folder == */* ]]; do
        folder=${folder%/*}
        if [[ -n ${may_include[$folder]:-} ]]; then
            printf %s "$folder"
            return
        fi
    done
}

project_allows() { # project_allows LAYER HEADER
    local prefix
    for prefix in ${may_include[$1]}; do
        [[ $2 != "${prefix#!}"* ]] || { [[ $prefix != !* ]]; return; }
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
    layer=$(layer_of "$file")
    if [[ $directive != *\"* ]]; then
        library_allows "$file" "$header" || crossed "<$header> has its home elsewhere"
    elif [[ $header != */* ]]; then
        crossed "\"$header\" is not named from the root of the repository"
    elif [[ -n $layer ]] && ! project_allows "$layer" "$header"; then
        crossed "$layer may not include \"$header\""
    fi
done < <(for folder in lang stdlib jit runtime device tools examples bench tests; do
    [[ ! -d $folder ]] || grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"]' "$folder" \
        --include='*.h' --include='*.c' --include='*.cpp' --include='*.def' --exclude-dir=broken_house || true
done)

printf '%s includes read, %s cross a wall\n' "$seen" "$crossings"
((seen > 0 && crossings == 0))
