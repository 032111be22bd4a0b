// Why a device cannot be opened, and what its user can do about it.
#pragma once

#include <string>

namespace haptel::device {

struct Refusal {
    std::string reason; // empty: it can be opened
    std::string cure;   // a sentence without its full stop

    bool empty() const { return reason.empty(); }
    std::string text() const { return cure.empty() ? reason : reason + ". " + cure; }
};

} // namespace haptel::device
