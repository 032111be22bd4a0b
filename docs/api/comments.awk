# Makes documentation of the comments of a public header, for Doxygen: a comment on lines of its own tells of what is
# below it, one behind code of that code, the one that opens the file of the file. What only moves is left out.

# `double x, y; // text` as `/** text */ double x; /** text */ double y;`, or only one of them would be told of.
function told(code, comment,    at, c, depth, part, type, out) {
    for (at = 1; at <= length(code); ++at) {
        c = substr(code, at, 1)
        depth += (c ~ /[({<]/) - (c ~ /[)}>]/)
        if (depth != 0 || c !~ /[,;]/) {
            part = part c
            continue
        }
        if (type == "" && match(part, /[*&]*[A-Za-z_0-9]+(\[[0-9]+\])*( = .*)?$/)) {
            type = substr(part, 1, RSTART - 1)
            part = substr(part, RSTART)
        }
        out = out "/** " comment " */ " type part "; "
        part = ""
    }
    return out
}
NR == 1 && /^\/\// { print "/// @file"; sub(/^\/\//, "///"); print; next }
NR == 1 && /^\/\*/ { sub(/^\/\*/, "/** @file\n *"); print; next }
/^#/ { print; next }
/&&\) noexcept;$/ { print ""; next }
/^ *\/\/ / { sub(/\/\/ /, "/// "); print; next }
/^ *\/\* / { sub(/\/\* /, "/** "); print; next }
match($0, / *(\/\/ .*|\/\* .*\*\/)$/) && substr($0, RSTART - 1, 1) == ";" {
    comment = substr($0, RSTART)
    gsub(/^ *(\/\/|\/\*) | *\*\/$/, "", comment)
    print told(substr($0, 1, RSTART - 1), comment)
    next
}
/[^ ] *\/\/ / { sub(/\/\/ /, "///< "); print; next }
/[^ ] *\/\* / { sub(/\/\* /, "/**< "); print; next }
{ print }
