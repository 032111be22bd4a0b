// Integers of any size, slow and obvious: the truth that exact predicates are measured against.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace haptel::test {

class BigInteger {
public:
    BigInteger(int64_t value = 0) : negative_(value < 0)
    {
        for (uint64_t v = negative_ ? 0 - uint64_t(value) : uint64_t(value); v != 0; v >>= 32)
            digits_.push_back(uint32_t(v));
    }

    int sign() const { return digits_.empty() ? 0 : negative_ ? -1 : 1; }

    BigInteger operator-() const
    {
        BigInteger result = *this;
        result.negative_ = !negative_;
        return result;
    }

    friend BigInteger operator+(const BigInteger& a, const BigInteger& b)
    {
        if (a.negative_ == b.negative_) return {sum(a.digits_, b.digits_), a.negative_};
        return less(a.digits_, b.digits_) ? BigInteger{difference(b.digits_, a.digits_), b.negative_}
                                          : BigInteger{difference(a.digits_, b.digits_), a.negative_};
    }
    friend BigInteger operator-(const BigInteger& a, const BigInteger& b) { return a + -b; }

    friend BigInteger operator*(const BigInteger& a, const BigInteger& b)
    {
        std::vector<uint32_t> digits(a.digits_.size() + b.digits_.size());
        for (size_t i = 0; i < a.digits_.size(); ++i) {
            uint64_t carry = 0;
            for (size_t j = 0; j < b.digits_.size() || carry != 0; ++j) {
                const uint64_t factor = j < b.digits_.size() ? b.digits_[j] : 0;
                carry += digits[i + j] + uint64_t(a.digits_[i]) * factor;
                digits[i + j] = uint32_t(carry);
                carry >>= 32;
            }
        }
        return {std::move(digits), a.negative_ != b.negative_};
    }

    // 2^(32 n) times this.
    BigInteger shifted(size_t n) const
    {
        BigInteger result = *this;
        if (!digits_.empty()) result.digits_.insert(result.digits_.begin(), n, 0u);
        return result;
    }

private:
    using Digits = std::vector<uint32_t>; // least first, no zeros at the end

    BigInteger(Digits digits, bool negative) : digits_(std::move(digits)), negative_(negative)
    {
        while (!digits_.empty() && digits_.back() == 0) digits_.pop_back();
    }
    static bool less(const Digits& a, const Digits& b)
    {
        if (a.size() != b.size()) return a.size() < b.size();
        return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
    }
    static Digits sum(const Digits& a, const Digits& b)
    {
        Digits result;
        uint64_t carry = 0;
        for (size_t i = 0; i < std::max(a.size(), b.size()) || carry != 0; ++i, carry >>= 32) {
            carry += (i < a.size() ? a[i] : 0) + uint64_t(i < b.size() ? b[i] : 0);
            result.push_back(uint32_t(carry));
        }
        return result;
    }
    static Digits difference(const Digits& larger, const Digits& smaller)
    {
        Digits result;
        int64_t borrow = 0;
        for (size_t i = 0; i < larger.size(); ++i) {
            int64_t digit = int64_t(larger[i]) - int64_t(i < smaller.size() ? smaller[i] : 0) + borrow;
            borrow = digit < 0 ? -1 : 0;
            result.push_back(uint32_t(digit));
        }
        return result;
    }

    Digits digits_;
    bool negative_ = false;
};

} // namespace haptel::test
