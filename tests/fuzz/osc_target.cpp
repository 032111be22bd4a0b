// Datagrams that claim to be OSC: whatever the bytes, they are read or refused, what is read is written and read again
// to the same, and each message is answered.
#include "tests/fuzz/target.h"
#include "tests/tools/control/fake_controlled.h"
#include "tests/tools/control/osc_bytes.h"
#include "tools/control/osc_control.h"

namespace haptel::fuzz {

using namespace haptel::tools;
using namespace haptel::test;

void hear_osc(std::string_view bytes)
{
    const OscParts parts = split_osc(bytes);
    if (!parts.error.empty() && !parts.messages.empty()) fail("messages beside an error");
    for (const std::string_view part : parts.messages) {
        const OscMessage message = read_osc(part);
        count(message.error.empty() ? "read" : "refused");
        if (!message.error.empty()) continue;
        const std::string written = write_osc(message);
        const OscMessage again = read_osc(written);
        if (!again.error.empty() || again.address != message.address) fail("what was written is refused");
        if (write_osc(again) != written) fail("what was written is read otherwise");
    }
    FakeControlled controlled;
    OscControl control(controlled);
    const auto now = OscControl::Clock::time_point{} + std::chrono::seconds(1);
    for (const OscDatagram& answer : control.take(bytes, {0, 7000}, now))
        if (answer.bytes.empty() || answer.bytes.size() % 4 != 0) fail("an answer that is no message");
    if (control.subscribers() > OscControl::subscribers_max) fail("more subscribers than there may be");
    for (const OscDatagram& told : control.state(now))
        if (!read_osc(told.bytes).error.empty()) fail("a state that is no message");
    count("done", controlled.done.size());
}

std::vector<std::string> osc_corpus()
{
    const std::string set = osc_string_message("/haptel/object/2/parameter/depth", "60um");
    return {set,
            osc_bytes("/haptel/object/2/parameter/size", "fidhTF",
                      osc_float(0.5f) + osc_word(3) + osc_word(1) + osc_word(2) + osc_word(3) + osc_word(4)),
            osc_string_message("/haptel/object/1/preset", "rock"),
            osc_bytes("/haptel/subscribe", "if", osc_word(30) + osc_float(7001)),
            osc_bytes("/haptel/list"),
            osc_bytes("/haptel/record/start"),
            osc_bytes("/haptel/scene/load", "b", osc_word(4) + "toml"),
            osc_bundle({set, osc_bundle({osc_bytes("/haptel/stop")}), osc_bytes("/haptel/start")})};
}

} // namespace haptel::fuzz
