// What devices say of their reports, and the reports that are made of it. The bytes expected here are worked out by
// hand from the published layouts.
#include "device/hid/hid_interface.h"
#include "device/hid/pid_reports.h"
#include "tests/device/hid/hid_items.h"
#include "tests/support/catch.h"

#include <cmath>
#include <limits>
#include <random>

using namespace haptel::device;

namespace {

using Bytes = std::vector<uint8_t>;

Bytes bytes_of(const PidReport& report)
{
    return {report.span().begin(), report.span().end()};
}

PidReports reports_of(const Bytes& descriptor)
{
    const HidDescriptor read = read_hid_descriptor(descriptor);
    REQUIRE(PidReports::lacking(read) == "");
    return PidReports(read);
}

// Whatever was read: each field lies in its report, and nothing that is done with it leaves it.
void hold_to_bounds(const HidDescriptor& read)
{
    for (const HidField& field : read.fields) {
        REQUIRE(field.bits >= 1);
        REQUIRE(field.bits <= 32);
        REQUIRE(field.bit + field.bits <= 8 * read.report_bytes(field.kind, field.report));
        REQUIRE(!field.usages.empty());
        REQUIRE(field.collection < read.collections.size());
    }
    for (const HidReport& report : read.reports) REQUIRE(report.bytes() <= hid_report_bytes_max);
    if (PidReports::lacking(read).empty()) {
        const PidReports reports(read);
        REQUIRE(reports.constant_force(1, 1).size > 0);
        REQUIRE(bytes_of(reports.endless_effect(1, 0)).size() <= 64);
    }
}

} // namespace

TEST_CASE("the reports of OpenFFBoard are found, and made byte by byte as it reads them")
{
    const PidReports reports = reports_of(openffboard_descriptor());
    CHECK(reports.axes() == 2);
    CHECK(reports.range(0).minimum == -32767);
    CHECK(reports.range(1).maximum == 32767);
    CHECK(reports.input_bytes() == 25);
    CHECK(bytes_of(reports.control(PidControl::enable_actuators)) == Bytes{12, 1});
    CHECK(bytes_of(reports.control(PidControl::stop_all)) == Bytes{12, 4});
    CHECK(bytes_of(reports.control(PidControl::reset)) == Bytes{12, 8});
    CHECK(bytes_of(*reports.full_gain()) == Bytes{13, 255});
    CHECK(reports.new_constant_force().kind == HidKind::feature);
    CHECK(bytes_of(reports.new_constant_force()) == Bytes{17, 1, 0, 0});
    CHECK(reports.ask_block().size == 5);
    CHECK(reports.ask_block().id == 18);
    // block, type, duration, three times that are 0, gain, button, axis and direction, 90 degrees, offsets
    CHECK(bytes_of(reports.endless_effect(3, 0)) ==
          Bytes{1, 3, 1, 0xff, 0xff, 0, 0, 0, 0, 0, 0, 255, 0, 0x05, 0x28, 0x23, 0, 0, 0, 0, 0, 0});
    CHECK(bytes_of(reports.endless_effect(4, 1)) ==
          Bytes{1, 4, 1, 0xff, 0xff, 0, 0, 0, 0, 0, 0, 255, 0, 0x06, 0, 0, 0, 0, 0, 0, 0, 0});
    CHECK(bytes_of(reports.start(3)) == Bytes{10, 3, 1, 1});
    CHECK(bytes_of(reports.constant_force(3, 1)) == Bytes{5, 3, 0xff, 0x7f});
    CHECK(bytes_of(reports.constant_force(3, -1)) == Bytes{5, 3, 0x01, 0x80});
    CHECK(bytes_of(reports.constant_force(3, 0.25)) == Bytes{5, 3, 0x00, 0x20}); // 8191.75
    CHECK(bytes_of(reports.constant_force(3, 7)) == Bytes{5, 3, 0xff, 0x7f});
    for (const double none : {std::numeric_limits<double>::quiet_NaN(), 0.0, -1e-9})
        CHECK(bytes_of(reports.constant_force(3, none)) == Bytes{5, 3, 0, 0});
    CHECK(bytes_of(reports.constant_force(3, std::numeric_limits<double>::infinity())) == Bytes{5, 3, 0xff, 0x7f});
}

TEST_CASE("a report of places is read as it was sent, and no other")
{
    const PidReports reports = reports_of(openffboard_descriptor());
    Bytes report(25, 0xff); // all buttons
    report[0] = 1;
    report[9] = 0x34, report[10] = 0x12;  // x: 0x1234
    report[11] = 0x01, report[12] = 0x80; // y: -32767
    CHECK(reports.place(0, report) == 0x1234);
    CHECK(reports.place(1, report) == -32767);
    report[11] = 0x00; // -32768 is no place
    CHECK(reports.place(1, report) == std::nullopt);
    report[0] = 2;
    CHECK(reports.place(0, report) == std::nullopt);
    report[0] = 1;
    CHECK(reports.place(0, std::span(report).first(10)) == std::nullopt);
    CHECK(reports.place(0, std::span(report).first(11)) == 0x1234);
    CHECK(reports.place(0, {}) == std::nullopt);
}

TEST_CASE("a device says whether it made room for an effect")
{
    const PidReports reports = reports_of(openffboard_descriptor());
    const auto loaded = [&](const Bytes& bytes) { return reports.block(bytes).loaded; };
    CHECK(loaded({18, 7, 1, 0, 0}) == PidLoaded::yes);
    CHECK(reports.block(Bytes{18, 7, 1, 0, 0}).index == 7);
    CHECK(loaded({18, 7, 2, 0, 0}) == PidLoaded::full);
    CHECK(loaded({18, 7, 3, 0, 0}) == PidLoaded::failed);
    CHECK(loaded({18, 7, 0, 0, 0}) == PidLoaded::no);
    CHECK(loaded({18, 0, 1, 0, 0}) == PidLoaded::failed); // no block has this number
    CHECK(loaded({18, 41, 1, 0, 0}) == PidLoaded::failed);
    CHECK(loaded({17, 7, 1, 0, 0}) == PidLoaded::no);
    CHECK(loaded({18, 7}) == PidLoaded::no);
    CHECK(loaded({}) == PidLoaded::no);
}

TEST_CASE("another device of the class has the same reports under other numbers")
{
    const PidReports reports = reports_of(pid_example_descriptor());
    CHECK(reports.axes() == 2);
    CHECK(reports.input_bytes() == 3);
    CHECK(reports.place(1, Bytes{1, 5, 0x81}) == -127);
    CHECK(bytes_of(reports.control(PidControl::enable_actuators)) == Bytes{9, 1});
    CHECK(bytes_of(reports.control(PidControl::stop_all)) == Bytes{9, 3});
    CHECK(bytes_of(reports.control(PidControl::reset)) == Bytes{9, 4});
    CHECK(!reports.full_gain());
    CHECK(bytes_of(reports.new_constant_force()) == Bytes{1, 2});
    CHECK(bytes_of(reports.endless_effect(1, 0)) == Bytes{3, 1, 2, 0xff, 0xff, 0, 0, 255, 0x05, 64, 0});
    CHECK(bytes_of(reports.endless_effect(2, 1)) == Bytes{3, 2, 2, 0xff, 0xff, 0, 0, 255, 0x06, 0, 0});
    CHECK(bytes_of(reports.start(2)) == Bytes{8, 2, 1, 1});
    CHECK(bytes_of(reports.constant_force(1, -1)) == Bytes{7, 1, 0x01, 0xff});
    CHECK(bytes_of(reports.constant_force(1, 0.5)) == Bytes{7, 1, 128, 0});
}

TEST_CASE("fields without ids, ranges pushed and taken back, and long items are read as the standard says")
{
    HidItems d;
    d.page(1).begin(4, 1).logical(0, 1).size(1, 3).item(0xa4, 0);                  // kept
    d.bytes.back() = 0xa4, d.bytes[d.bytes.size() - 2] = 0xfe, d.bytes.back() = 2; // a long item of two bytes
    d.bytes.insert(d.bytes.end(), {0x10, 0xaa, 0xbb});
    d.bytes.push_back(0xa4); // Push
    d.logical(-4, 3).size(3, 1).usages({0x31}).input(hid_data);
    d.bytes.push_back(0xb4); // Pop
    d.usages({0x30}).input(hid_data).item(0x14, 0).bytes.insert(d.bytes.end(), {0x25, 0xff});
    d.size(8, 1).usages({0x32}).size(8, 1).input(hid_data).end();
    const HidDescriptor read = read_hid_descriptor(d.bytes);
    REQUIRE(read.error == "");
    const HidField* y = read.find(HidKind::input, 0, 0x00010031);
    const HidField* x = read.find(HidKind::input, 0x00010004, 0x00010030);
    const HidField* z = read.find(HidKind::input, 0, 0x00010032);
    REQUIRE((x && y && z));
    CHECK(read.find(HidKind::input, 0x00010005, 0x00010030) == nullptr);
    CHECK(y->bit == 0);
    CHECK(y->bits == 3);
    CHECK(x->bit == 3);
    CHECK(x->maximum == 1);
    CHECK(z->bit == 6); // three of x's size
    CHECK(z->maximum == 255);
    const Bytes transfer = {0b1100'1101, 0b0011'1111}; // y = 5 - 8, x = 1, z = 0xff
    CHECK(hid_value(*y, transfer) == -3);
    CHECK(hid_value(*x, transfer) == 1);
    CHECK(hid_value(*z, transfer) == 255);
    Bytes made(2, 0);
    put_hid_value(*y, made, -3);
    put_hid_value(*x, made, 9); // limited
    put_hid_value(*z, made, 255);
    CHECK(made == Bytes{0b1100'1101, 0b0011'1111});
}

TEST_CASE("what lacks a report is told of by its name")
{
    const auto lacking = [](const Bytes& bytes) { return PidReports::lacking(read_hid_descriptor(bytes)); };
    CHECK(lacking({}) == "its reports lack an axis X to feel along: it is no device of the class PID");
    HidItems pad;
    pad.page(1).begin(5, 1).usages({0x30, 0x31}).logical(0, 255).size(8, 2).input(hid_data).end();
    CHECK(lacking(pad.bytes) == "its reports lack Set Effect: it is no device of the class PID");
    Bytes one_way = pid_example_descriptor();
    const Bytes range = {0x16, 0x01, 0xff, 0x26, 0xff, 0x00}; // -255 .. 255
    const auto at = std::search(one_way.begin(), one_way.end(), range.begin(), range.end());
    REQUIRE(at != one_way.end());
    at[1] = 0, at[2] = 0;
    CHECK(lacking(one_way) == "its constant force pushes one way only");
    const Bytes endless(5000, 0xc0);
    CHECK(lacking(endless).find("longer than any device's") != std::string::npos);
    CHECK(lacking({0xc0}).find("ends a collection that never began") != std::string::npos);
    CHECK(lacking({0xb4}).find("takes back what it never kept") != std::string::npos);
    CHECK(lacking({0x85, 0x00}).find("an id that none can have") != std::string::npos);
    CHECK(lacking({0x09, 0x30, 0x75, 0x20, 0x97, 0xff, 0xff, 0xff, 0xff, 0x81, 0x02}).find("longer than any can be") !=
          std::string::npos);
    CHECK(lacking(Bytes(100, 0xa1)).find("cannot be read") != std::string::npos);
}

TEST_CASE("a descriptor that is cut off anywhere is refused or lies within bounds")
{
    for (const Bytes& whole : {openffboard_descriptor(), pid_example_descriptor()}) {
        std::size_t usable = 0;
        for (std::size_t size = 0; size < whole.size(); ++size) {
            const HidDescriptor read = read_hid_descriptor(std::span(whole).first(size));
            hold_to_bounds(read);
            usable += PidReports::lacking(read).empty();
        }
        CHECK(usable == 0); // its outermost collection never ends
    }
}

TEST_CASE("bytes at random, and descriptors with bytes changed at random, lie within bounds")
{
    std::mt19937 random(1);
    std::size_t usable = 0;
    for (int run = 0; run < 20'000; ++run) {
        Bytes bytes = run % 2 == 0 ? openffboard_descriptor() : pid_example_descriptor();
        if (run % 5 == 0) bytes.assign(random() % 300, 0);
        const std::size_t changes = run % 5 == 0 ? bytes.size() : 1 + random() % 4;
        for (std::size_t i = 0; i < changes && !bytes.empty(); ++i)
            bytes[run % 5 == 0 ? i : random() % bytes.size()] = static_cast<uint8_t>(random());
        const HidDescriptor read = read_hid_descriptor(bytes);
        hold_to_bounds(read);
        usable += PidReports::lacking(read).empty();
    }
    CHECK(usable > 1000);
}

TEST_CASE("HID interfaces are found among others, with their endpoints")
{
    const Bytes configuration = {9, 2,    0,    0,    3,    1, 0,    0x80, 50,   //
                                 9, 4,    0,    0,    1,    2, 2,    1,    0,    // a serial port
                                 7, 5,    0x82, 3,    8,    0, 16,               //
                                 9, 4,    2,    0,    2,    3, 0,    0,    0,    // HID
                                 9, 0x21, 0x11, 0x01, 0,    1, 0x22, 0x34, 0x02, // 0x234 bytes
                                 7, 5,    0x83, 3,    64,   0, 1,                //
                                 7, 5,    0x02, 3,    0x20, 0, 1};
    const auto found = hid_interfaces(configuration);
    REQUIRE(found.size() == 1);
    CHECK(found[0].number == 2);
    CHECK(found[0].in_endpoint == 0x83);
    CHECK(found[0].out_endpoint == 0x02);
    CHECK(found[0].packet_bytes == 64);
    CHECK(found[0].descriptor_bytes == 0x234);
    for (std::size_t size = 0; size < configuration.size(); ++size)
        CHECK(hid_interfaces(std::span(configuration).first(size)).size() <= 1);
    std::mt19937 random(2);
    for (int run = 0; run < 20'000; ++run) {
        Bytes bytes = configuration;
        for (int i = 0; i < 3; ++i) bytes[random() % bytes.size()] = static_cast<uint8_t>(random());
        CHECK(hid_interfaces(bytes).size() <= bytes.size() / 9);
    }
}
