#include "device/hid/hid_descriptor.h"

#include <algorithm>
#include <array>

namespace haptel::device {

namespace {

constexpr std::size_t fields_max = 4096, usages_max = 512, collections_max = 512, depth_max = 32, pushed_max = 16;
constexpr uint32_t field_bits_max = 32;

enum class ItemType : uint8_t { main, global, local, reserved };

struct Item {
    ItemType type = ItemType::reserved;
    uint8_t tag = 0;
    uint8_t size = 0; // bytes of its value
    uint32_t value = 0;
    int64_t as_signed() const
    {
        return size == 1   ? static_cast<int8_t>(value)
               : size == 2 ? static_cast<int16_t>(value)
                           : static_cast<int32_t>(value);
    }
};

// What global items set until they are set again.
struct Globals {
    uint32_t page = 0, report_size = 0, report_count = 0;
    Item minimum, maximum;
    uint8_t report = 0;
};

// A usage of four bytes names its page; a shorter one is of the page in force at the main item.
struct LocalUsage {
    uint32_t value = 0;
    bool has_page = false;
};

class DescriptorReader {
public:
    explicit DescriptorReader(std::span<const uint8_t> bytes) : bytes_(bytes) { read_.collections.push_back({}); }

    HidDescriptor run()
    {
        if (bytes_.size() > hid_descriptor_bytes_max) return refused("longer than any device's");
        while (at_ < bytes_.size() && read_.error.empty()) {
            if (bytes_[at_] == long_item) {
                if (!skip_long_item()) return refused("cut off");
                continue;
            }
            const std::optional<Item> item = next();
            if (!item) return refused("cut off");
            switch (item->type) {
            case ItemType::main: main_item(*item); break;
            case ItemType::global: global_item(*item); break;
            case ItemType::local: local_item(*item); break;
            case ItemType::reserved: break;
            }
        }
        if (read_.error.empty() && !open_.empty()) return refused("cut off inside a collection");
        return std::move(read_);
    }

private:
    static constexpr uint8_t long_item = 0xfe;

    HidDescriptor refused(std::string_view why)
    {
        HidDescriptor none;
        none.error = "its report descriptor cannot be read: it is " + std::string(why);
        return none;
    }
    void fail(std::string_view why) { read_ = refused(why); }

    bool skip_long_item()
    {
        if (bytes_.size() - at_ < 3) return false;
        const std::size_t size = std::size_t{3} + bytes_[at_ + 1];
        if (bytes_.size() - at_ < size) return false;
        at_ += size;
        return true;
    }

    std::optional<Item> next()
    {
        const uint8_t prefix = bytes_[at_++];
        constexpr std::array<uint8_t, 4> sizes = {0, 1, 2, 4};
        Item item{static_cast<ItemType>(prefix >> 2 & 3), static_cast<uint8_t>(prefix >> 4), sizes[prefix & 3], 0};
        if (bytes_.size() - at_ < item.size) return std::nullopt;
        for (uint32_t i = 0; i < item.size; ++i) item.value |= uint32_t{bytes_[at_ + i]} << (8 * i);
        at_ += item.size;
        return item;
    }

    void global_item(const Item& item)
    {
        switch (item.tag) {
        case 0x0: now_.page = item.value & 0xffff; break;
        case 0x1: now_.minimum = item; break;
        case 0x2: now_.maximum = item; break;
        case 0x7: now_.report_size = item.value; break;
        case 0x8:
            if (item.value == 0 || item.value > 0xff) return fail("wrong: a report has an id that none can have");
            now_.report = static_cast<uint8_t>(item.value);
            break;
        case 0x9: now_.report_count = item.value; break;
        case 0xa:
            if (pushed_.size() == pushed_max) return fail("nested too deeply");
            pushed_.push_back(now_);
            break;
        case 0xb:
            if (pushed_.empty()) return fail("wrong: it takes back what it never kept");
            now_ = pushed_.back();
            pushed_.pop_back();
            break;
        default: break; // physical ranges and units
        }
    }

    void local_item(const Item& item)
    {
        const LocalUsage usage{item.value, item.size == 4};
        switch (item.tag) {
        case 0x0:
            if (usages_.size() < usages_max) usages_.push_back(usage);
            break;
        case 0x1: first_ = usage; break;
        case 0x2:
            if (!first_) break;
            for (uint64_t value = first_->value; value <= item.value && usages_.size() < usages_max; ++value)
                usages_.push_back({static_cast<uint32_t>(value), first_->has_page});
            first_.reset();
            break;
        default: break; // designators and strings
        }
    }

    void main_item(const Item& item)
    {
        switch (item.tag) {
        case 0x8: add_fields(HidKind::input, item.value); break;
        case 0x9: add_fields(HidKind::output, item.value); break;
        case 0xb: add_fields(HidKind::feature, item.value); break;
        case 0xa:
            if (open_.size() == depth_max || read_.collections.size() == collections_max)
                return fail("nested too deeply");
            read_.collections.push_back({usages_.empty() ? 0 : full(usages_.front()), inside()});
            open_.push_back(static_cast<uint32_t>(read_.collections.size() - 1));
            break;
        case 0xc:
            if (open_.empty()) return fail("wrong: it ends a collection that never began");
            open_.pop_back();
            break;
        default: break;
        }
        usages_.clear();
        first_.reset();
    }

    uint32_t inside() const { return open_.empty() ? 0 : open_.back(); }
    HidUsage full(const LocalUsage& usage) const
    {
        return usage.has_page ? usage.value : now_.page << 16 | usage.value;
    }

    HidReport& report(HidKind kind)
    {
        for (HidReport& each : read_.reports)
            if (each.kind == kind && each.id == now_.report) return each;
        read_.reports.push_back({kind, now_.report, now_.report == 0 ? 0U : 8U});
        return read_.reports.back();
    }

    void add_fields(HidKind kind, uint32_t flags)
    {
        HidReport& within = report(kind);
        const uint64_t bits = uint64_t{now_.report_size} * now_.report_count;
        if (within.bits + bits > 8 * hid_report_bytes_max) return fail("wrong: a report is longer than any can be");
        const bool padding = flags & 1, selects = !(flags & 2);
        if (!padding && !usages_.empty() && now_.report_size > 0 && now_.report_size <= field_bits_max)
            for (uint32_t i = 0; i < now_.report_count; ++i) {
                HidField field;
                field.kind = kind;
                field.report = now_.report;
                field.bit = within.bits + i * now_.report_size;
                field.bits = static_cast<uint8_t>(now_.report_size);
                field.selects = selects;
                field.collection = inside();
                field.minimum = now_.minimum.as_signed();
                // Many write 0xff for 255 where nothing is negative.
                field.maximum = field.minimum < 0 ? now_.maximum.as_signed() : int64_t{now_.maximum.value};
                // The last usage is that of all further ones.
                if (!selects) field.usages = {full(usages_[std::min<std::size_t>(i, usages_.size() - 1)])};
                // One choice of several at a time would do; the first is enough to say one thing.
                if (selects)
                    for (const LocalUsage& usage : usages_) field.usages.push_back(full(usage));
                if (read_.fields.size() == fields_max) return fail("wrong: it has more fields than any device");
                read_.fields.push_back(std::move(field));
                if (selects) break;
            }
        within.bits += static_cast<uint32_t>(bits);
    }

    std::span<const uint8_t> bytes_;
    std::size_t at_ = 0;
    HidDescriptor read_;
    Globals now_;
    std::vector<Globals> pushed_;
    std::vector<LocalUsage> usages_;
    std::optional<LocalUsage> first_;
    std::vector<uint32_t> open_;
};

bool lies_within(const HidDescriptor& descriptor, uint32_t collection, HidUsage usage)
{
    for (uint32_t at = collection;; at = descriptor.collections[at].parent) {
        if (descriptor.collections[at].usage == usage) return true;
        if (descriptor.collections[at].parent == at) return false;
    }
}

} // namespace

HidDescriptor read_hid_descriptor(std::span<const uint8_t> bytes)
{
    return DescriptorReader(bytes).run();
}

const HidField* HidDescriptor::find(HidKind kind, HidUsage within, HidUsage usage) const
{
    for (const HidField& field : fields)
        if (field.kind == kind && std::ranges::find(field.usages, usage) != field.usages.end() &&
            (within == 0 || lies_within(*this, field.collection, within)))
            return &field;
    return nullptr;
}

std::size_t HidDescriptor::report_bytes(HidKind kind, uint8_t id) const
{
    for (const HidReport& report : reports)
        if (report.kind == kind && report.id == id) return report.bytes();
    return 0;
}

std::size_t HidDescriptor::longest(HidKind kind) const
{
    std::size_t longest = 0;
    for (const HidReport& report : reports)
        if (report.kind == kind) longest = std::max(longest, report.bytes());
    return longest;
}

std::optional<int64_t> hid_value(const HidField& field, std::span<const uint8_t> transfer) noexcept
{
    if (std::size_t{8} * transfer.size() < field.bit + field.bits) return std::nullopt;
    if (field.report != 0 && transfer[0] != field.report) return std::nullopt;
    uint64_t raw = 0;
    for (uint32_t i = 0; i < field.bits; ++i) {
        const uint32_t bit = field.bit + i;
        raw |= uint64_t{transfer[bit / 8] >> (bit % 8) & 1U} << i;
    }
    auto value = static_cast<int64_t>(raw);
    if (field.minimum < 0 && raw >> (field.bits - 1) & 1) value -= int64_t{1} << field.bits;
    if (value < field.minimum || value > field.maximum) return std::nullopt;
    return value;
}

void put_hid_value(const HidField& field, std::span<uint8_t> transfer, int64_t value) noexcept
{
    if (field.minimum <= field.maximum) value = std::clamp(value, field.minimum, field.maximum);
    put_hid_bits(field, transfer, static_cast<uint64_t>(value));
}

void put_hid_bits(const HidField& field, std::span<uint8_t> transfer, uint64_t bits) noexcept
{
    if (std::size_t{8} * transfer.size() < field.bit + field.bits) return;
    for (uint32_t i = 0; i < field.bits; ++i) {
        const uint32_t bit = field.bit + i;
        const auto mask = static_cast<uint8_t>(1U << (bit % 8));
        if (bits >> i & 1)
            transfer[bit / 8] |= mask;
        else
            transfer[bit / 8] = static_cast<uint8_t>(transfer[bit / 8] & ~mask);
    }
}

std::optional<int64_t> hid_choice(const HidField& field, HidUsage usage) noexcept
{
    const auto found = std::ranges::find(field.usages, usage);
    if (found == field.usages.end()) return std::nullopt;
    return field.selects ? field.minimum + (found - field.usages.begin()) : 1;
}

} // namespace haptel::device
