#include "tools/sound/render_report.h"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace haptel::tools {

namespace {

double seconds_of(const RenderOutcome& outcome)
{
    return static_cast<double>(outcome.frames) / outcome.rate_hz;
}

std::string level_in_words(const RenderOutcome& outcome)
{
    const double peak_n = outcome.level.peak_n();
    if (peak_n == 0) return "silent";
    const double below_db = 20 * std::log10(outcome.full_scale_n / peak_n);
    return fmt::format("peak {:.4g} N, {:.1f} dB {} full scale; rms {:.4g} N", peak_n, std::abs(below_db),
                       below_db < 0 ? "above" : "below", outcome.level.rms_n());
}

} // namespace

Json to_json(const RenderOutcome& outcome)
{
    Json json;
    json["seconds"] = seconds_of(outcome);
    json["rate_hz"] = outcome.rate_hz;
    json["channels"] = outcome.components.size();
    json["components"] = outcome.components;
    json["format"] = outcome.format.empty() ? Json(nullptr) : Json(outcome.format);
    json["high_pass_hz"] = outcome.high_pass_hz;
    json["newton_per_unit"] = finite_or_null(outcome.full_scale_n);
    json["peak_n"] = finite_or_null(outcome.level.peak_n());
    json["rms_n"] = finite_or_null(outcome.level.rms_n());
    json["clipped_samples"] = outcome.clipped;
    json["contact_ticks"] = outcome.contact_ticks;
    json["faults"] = outcome.faults;
    json["underruns"] = value_or_null(outcome.underruns);
    return json;
}

std::string to_lines(const RenderOutcome& outcome)
{
    std::string lines = fmt::format("{}: {:.4g} s of {} at {:g} Hz{}\n", outcome.to, seconds_of(outcome),
                                    fmt::join(outcome.components, ", "), outcome.rate_hz,
                                    outcome.format.empty()      ? ""
                                    : outcome.format == "float" ? ", float"
                                                                : fmt::format(", {} bit", outcome.format));
    lines += fmt::format("  full scale   {:.6g} N\n  level        {}\n", outcome.full_scale_n, level_in_words(outcome));
    lines += outcome.high_pass_hz > 0 ? fmt::format("  high-pass    {:g} Hz\n", outcome.high_pass_hz)
                                      : "  high-pass    off: constant forces are in it\n";
    lines += fmt::format("  clipped      {} samples\n", outcome.clipped);
    if (outcome.underruns) lines += fmt::format("  gaps         {}\n", *outcome.underruns);
    if (outcome.faults > 0)
        lines += fmt::format("  faults       {} ticks had a texture, a pose or a force that is not finite\n",
                             outcome.faults);
    return lines;
}

} // namespace haptel::tools
