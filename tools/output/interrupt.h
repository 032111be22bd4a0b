// Ctrl-C, asked for politely: a clean end of what runs until then.
#pragma once

namespace haptel::tools {

// From now on the first Ctrl-C, or the terminal's end, is only noted; the second one gets what it always gets. Before
// that a signal ends the program as it ends any.
void listen_for_interrupts();

bool interrupted(); // since then

} // namespace haptel::tools
