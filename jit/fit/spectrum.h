// Power of a line of samples in bands of a third of an octave, and how it moves when the samples do.
#pragma once

#include <complex>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace haptel::jit {

// Of frequencies in cycles per unit of length or time, as the samples are apart.
struct Band {
    double from = 0, to = 0;
    double middle() const;
};

// Thirds of octaves over a range, as far as lines of `count` samples `step` apart tell them: each has at least three
// frequencies of the transform and lies below 0.9 of the highest one.
std::vector<Band> thirds_of_octaves(double from, double to, std::size_t count, double step);

// Where pieces of `count` samples begin that overlap by half or more and lie over all of a record of `length`.
std::vector<std::size_t> pieces_of(std::size_t length, std::size_t count);

// Lines of one length, under Hann's window, their means taken off. Not for several threads at once.
class LineSpectrum {
public:
    LineSpectrum(std::size_t count, double step, std::vector<Band> of_bands);
    ~LineSpectrum();
    const std::vector<Band>& bands() const { return all; }

    // The mean square of what the line has in each band, in the square of its unit; keeps the line for moves().
    std::vector<double> powers(std::span<const double> line);
    // How those powers move when the line moves like that.
    std::vector<double> moves(std::span<const double> line_moves);
    // Over longer records: the mean over their pieces, seen through a filter: by its gain for power at a frequency.
    std::vector<double> mean_powers(std::span<const std::vector<double>> records,
                                    const std::function<double(double)>& gain);
    // Of noise that is white with a mean square of 1, seen through such a filter.
    std::vector<double> noise(const std::function<double(double)>& gain) const;

private:
    const std::vector<Band> all;
    const double step;
    std::vector<double> window;
    std::vector<int> band_of; // by frequency of the transform; -1: of none
    std::vector<std::complex<double>> line_transform;
    struct Fourier;
    const std::unique_ptr<Fourier> fourier; // keeps the roots of unity of its length: most of a transform's time

    double frequency(std::size_t k) const
    {
        return static_cast<double>(k) / (step * static_cast<double>(window.size()));
    }
    std::vector<std::complex<double>> transform(std::span<const double> line); // frequencies up to the highest
};

} // namespace haptel::jit
