#!/usr/bin/env bash
# stands_alone.sh PROGRAM REGEX: fails, and shows them, if a library or symbol that PROGRAM needs or holds fits REGEX.
set -euo pipefail
everything=$(ldd "$1" && nm --demangle "$1")
if grep -E -m 20 "$2" <<<"$everything"; then
    echo "$1 holds what its layer must not know"
    exit 1
fi
echo "$(wc -l <<<"$everything") libraries and symbols, none of $2"
