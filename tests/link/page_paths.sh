#!/usr/bin/env bash
# page_paths.sh ROOT: fails, and says where, if a page names a file, a folder or a picture of the project that is not there.
set -euo pipefail
cd "$1"
missing=0
check() { # check PAGE FOLDER-IT-STARTS-FROM, one path per line on standard input
    local path
    while read -r path; do
        [[ -e $2/$path ]] && continue
        printf '%s: there is no %s\n' "$1" "$path"
        missing=1
    done
}
for page in README.md CONTRIBUTING.md docs/*.md; do
    # In backquotes, from the root: the name of a folder of ours, and what follows it up to an argument or a colon.
    check "$page" . < <(grep -oE '`(bench|device|docs|examples|input|jit|lang|libraries|materials|runtime|stdlib|tests|tools)/[A-Za-z0-9_./-]*' "$page" |
        sed 's/^`//' | sort -u)
    # Links and pictures, from the page; an address has a colon and is left alone.
    check "$page" "$(dirname "$page")" < <(grep -oE '\]\([A-Za-z0-9_./-]+(#[^)]*)?\)' "$page" |
        sed -E 's/^\]\(//; s/(#.*)?\)$//' | sort -u)
done
exit $missing
