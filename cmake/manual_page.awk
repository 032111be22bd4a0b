# Makes the manual page of the command from what `haptel --help` prints.
function plain(text) { gsub(/\\/, "\\e", text); gsub(/-/, "\\-", text); return text }
NR == 1 {
    print ".TH HAPTEL 1 \"\" \"Haptel " version "\" \"User Commands\"\n.SH NAME\nhaptel \\- touch textures that are written like shaders"
    print ".SH SYNOPSIS\n.B haptel\n[OPTIONS] SUBCOMMAND\n.SH DESCRIPTION\n" plain($0)
    next
}
/^Options:/ { print ".SH OPTIONS"; next }
/^Subcommands:/ { print ".SH SUBCOMMANDS"; next }
/^  [^ ]/ {
    name = $0
    sub(/^  /, "", name)
    match(name, /   */)
    print ".TP\n.B " plain(substr(name, 1, RSTART - 1)) "\n" plain(substr(name, RSTART + RLENGTH))
}
END { print ".PP\n.B haptel SUBCOMMAND \\-\\-help\nlists what a subcommand takes, with examples." }
