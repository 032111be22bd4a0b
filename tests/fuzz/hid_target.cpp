// Bytes that claim to be a HID device's report descriptor, and the reports that follow it.
#include "device/hid/hid_interface.h"
#include "device/hid/pid_reports.h"
#include "tests/device/hid/hid_items.h"
#include "tests/fuzz/target.h"

namespace haptel::fuzz {
namespace {

using namespace haptel::device;

void check_reports(const PidReports& reports, std::span<const uint8_t> transfer)
{
    for (int axis = 0; axis < reports.axes(); ++axis) {
        const AxisRange range = reports.range(axis);
        const auto place = reports.place(axis, transfer);
        if (place && (*place < range.minimum || *place > range.maximum)) fail("a place out of its range");
        if (reports.endless_effect(1, axis).size > sizeof(PidReport::bytes)) fail("an effect longer than a packet");
    }
    const PidBlock block = reports.block(transfer);
    if (block.loaded == PidLoaded::yes && block.index == 0) fail("a block without a number");
    if (reports.level_counts(1) != -reports.level_counts(-1)) fail("a force that is not as strong both ways");
}

} // namespace

void read_hid(std::string_view bytes)
{
    const auto all = std::span(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
    hid_interfaces(all);
    const HidDescriptor read = read_hid_descriptor(all);
    for (const HidField& field : read.fields) {
        if (field.bit + field.bits > 8 * read.report_bytes(field.kind, field.report)) fail("a field beyond its report");
        if (hid_value(field, all).value_or(field.minimum) < field.minimum) fail("a value out of its range");
    }
    const bool usable = PidReports::lacking(read).empty();
    if (usable) check_reports(PidReports(read), all);
    count(usable ? "devices" : "no devices");
}

std::vector<std::string> hid_corpus()
{
    std::vector<std::string> corpus;
    for (const auto& descriptor : {openffboard_descriptor(), pid_example_descriptor()})
        corpus.emplace_back(descriptor.begin(), descriptor.end());
    return corpus;
}

} // namespace haptel::fuzz
