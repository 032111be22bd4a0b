#include "tools/control/osc_control.h"

#include "lang/text/near_name.h"
#include "lang/text/source.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>
#include <utility>

namespace haptel::tools {

namespace {

constexpr std::string_view object_prefix = "/haptel/object/";
constexpr std::size_t shown_max = 120; // bytes of what somebody sent, in a message
constexpr std::size_t told_max = 1000; // messages about a scene

// Known whole; those of objects begin with object_prefix.
constexpr std::string_view addresses[] = {"/haptel/start",        "/haptel/stop",        "/haptel/list",
                                          "/haptel/subscribe",    "/haptel/unsubscribe", "/haptel/scene/load",
                                          "/haptel/record/start", "/haptel/record/stop"};

std::string shown(std::string_view text)
{
    return lang::printable(text.substr(0, shown_max)) + (text.size() > shown_max ? "..." : "");
}

std::string joined(const std::vector<OscValue>& values)
{
    std::vector<std::string> texts;
    for (const OscValue& value : values) texts.push_back(text_of(value));
    return fmt::format("{}", fmt::join(texts, ", "));
}

std::optional<double> number_of(const OscValue& value)
{
    return std::visit(
        [](const auto& held) -> std::optional<double> {
            if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::string>)
                return std::nullopt;
            else
                return static_cast<double>(held);
        },
        value);
}

// The only argument, a text; or nothing.
const std::string* only_text(const OscMessage& message)
{
    return message.values.size() == 1 ? std::get_if<std::string>(&message.values[0]) : nullptr;
}

ControlAnswer refused(std::string why)
{
    return {std::move(why), {}};
}

ControlAnswer unknown_address(const std::string& address)
{
    const std::string_view meant = near_name(address, {std::begin(addresses), std::end(addresses)}).name;
    return refused(fmt::format(
        "there is no such address{}: expected {}, /haptel/object/NUMBER/parameter/NAME or /haptel/object/NUMBER/preset",
        meant.empty() ? "" : fmt::format(", did you mean {}?", meant), fmt::join(addresses, ", ")));
}

// An error is never answered, or two programs could answer each other for ever; nor is anything that Haptel tells.
bool is_told_by_haptel(std::string_view address)
{
    return address == "/haptel/ok" || address == "/haptel/error" || address == "/haptel/message" ||
           address.starts_with("/haptel/state/");
}

std::string state_address(uint32_t object, const std::string& parameter)
{
    return fmt::format("/haptel/state/object/{}/parameter/{}", object, parameter);
}

OscMessage vector_message(std::string address, const glm::dvec3& vector)
{
    return {std::move(address),
            {static_cast<float>(vector.x), static_cast<float>(vector.y), static_cast<float>(vector.z)}};
}

int32_t whole(uint64_t number)
{
    return static_cast<int32_t>(std::min<uint64_t>(number, INT32_MAX));
}

std::vector<OscMessage> about(const ControlledHand& hand, std::size_t number)
{
    const std::string at = fmt::format("/haptel/state/hand/{}/", number);
    return {vector_message(at + "position", hand.position_m),
            vector_message(at + "force", hand.force_n),
            {at + "contact", {whole(hand.contact)}},
            {at + "object", {whole(hand.object)}},
            {at + "fault", {whole(hand.faults)}},
            {at + "missed_deadlines", {whole(hand.missed_deadlines)}}};
}

std::vector<OscMessage> about_parameters(const std::vector<ControlledObject>& objects)
{
    std::vector<OscMessage> messages;
    for (const ControlledObject& object : objects)
        for (const auto& [name, value] : object.parameters)
            if (messages.size() <= told_max) messages.push_back({state_address(object.number, name), {value}});
    return messages;
}

} // namespace

std::vector<OscDatagram> OscControl::take(std::string_view datagram, OscPeer from, Clock::time_point now)
{
    std::vector<OscDatagram> answers;
    const auto answer = [&](const OscMessage& message) { answers.push_back({from, write_osc(message)}); };
    const OscParts parts = split_osc(datagram);
    if (!parts.error.empty()) answer({"/haptel/error", {std::string(), parts.error}});
    for (const std::string_view bytes : parts.messages) {
        OscMessage message = read_osc(bytes);
        if (is_told_by_haptel(message.address)) continue;
        const std::string address = shown(message.address);
        std::vector<OscMessage> told;
        const ControlAnswer done =
            message.error.empty() ? act(message, from, now, told) : refused(std::move(message.error));
        for (const OscMessage& one : told) answer(one);
        if (!done.refused.empty())
            answer({"/haptel/error", {address, done.refused}});
        else if (done.remark.empty())
            answer({"/haptel/ok", {address}});
        else
            answer({"/haptel/ok", {address, done.remark}});
    }
    return answers;
}

ControlAnswer OscControl::act(const OscMessage& message, OscPeer from, Clock::time_point now,
                              std::vector<OscMessage>& told)
{
    const std::string& address = message.address;
    if (address.starts_with(object_prefix)) return act_on_object(message, told);
    if (address == "/haptel/subscribe") return subscribe(message, from, now);
    if (address == "/haptel/scene/load") {
        if (const std::string* file = only_text(message)) return controlled_.load_scene(*file);
        return refused("expected one text, the name of a scene file in the folder of the first: \"other.toml\"");
    }
    if (std::ranges::find(addresses, address) == std::end(addresses)) return unknown_address(address);
    if (!message.values.empty()) return refused(fmt::format("expected no arguments, found {}", message.values.size()));
    if (address == "/haptel/list") {
        told = list();
        if (told.size() <= told_max) return {};
        told.resize(told_max);
        return {{}, fmt::format("the first {} messages of more", told_max)};
    }
    if (address == "/haptel/unsubscribe") return unsubscribe(from);
    if (address == "/haptel/record/start") return controlled_.start_recording();
    if (address == "/haptel/record/stop") return controlled_.stop_recording();
    controlled_.withhold_force(address == "/haptel/stop");
    return {};
}

// /haptel/object/NUMBER/parameter/NAME, /haptel/object/NUMBER/preset
ControlAnswer OscControl::act_on_object(const OscMessage& message, std::vector<OscMessage>& told)
{
    const std::string_view rest = std::string_view(message.address).substr(object_prefix.size());
    const std::string_view number_text = rest.substr(0, rest.find('/'));
    const std::string_view what = rest.substr(std::min(rest.size(), number_text.size() + 1));
    uint32_t number = 0;
    const auto [end, failed] = std::from_chars(number_text.data(), number_text.data() + number_text.size(), number);
    if (failed != std::errc() || end != number_text.data() + number_text.size() || number == 0)
        return refused(fmt::format("expected the number of an object of the scene, from 1, found '{}': /haptel/list "
                                   "tells them",
                                   shown(number_text)));
    if (what == "preset") {
        if (const std::string* name = only_text(message)) return controlled_.choose_preset(number, *name);
        return refused("expected one text, the name of a preset: /haptel/list tells them");
    }
    constexpr std::string_view parameter = "parameter/";
    if (!what.starts_with(parameter) || what.size() == parameter.size()) return unknown_address(message.address);
    const std::string name(what.substr(parameter.size()));
    if (!message.values.empty()) return controlled_.set(number, name, joined(message.values));
    for (const ControlledObject& object : controlled_.objects())
        if (object.number == number)
            for (const auto& [known, value] : object.parameters)
                if (known == name) told.push_back({state_address(number, name), {value}});
    return told.empty() ? refused(fmt::format("object {} has no parameter '{}' with a value: /haptel/list tells them",
                                              number, shown(name)))
                        : ControlAnswer{};
}

ControlAnswer OscControl::subscribe(const OscMessage& message, OscPeer from, Clock::time_point now)
{
    const std::string expected =
        fmt::format("expected a rate from 1 to {} Hz or nothing, and a port from 1 to 65535 or nothing", rate_max_hz);
    if (message.values.size() > 2) return refused(expected + fmt::format(", found {} values", message.values.size()));
    double rate_hz = rate_default_hz;
    if (!message.values.empty()) {
        rate_hz = number_of(message.values[0]).value_or(0);
        if (!(rate_hz >= 1 && rate_hz <= rate_max_hz))
            return refused(expected + ", found '" + shown(text_of(message.values[0])) + "' as the rate");
    }
    if (message.values.size() == 2) {
        const double port = number_of(message.values[1]).value_or(0);
        if (!(port >= 1 && port <= 65535) || port != std::floor(port))
            return refused(expected + ", found '" + shown(text_of(message.values[1])) + "' as the port");
        from.port = static_cast<uint16_t>(port);
    }
    std::erase_if(subscribers_, [&](const Subscriber& one) { return one.peer == from || one.until < now; });
    if (subscribers_.size() >= subscribers_max)
        return refused(
            fmt::format("{} programs have subscribed already, which are all that there may be", subscribers_max));
    const auto interval = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate_hz));
    subscribers_.push_back({from, interval, now, now + subscribed_for});
    return {};
}

ControlAnswer OscControl::unsubscribe(OscPeer from)
{
    const bool was_there = std::erase_if(subscribers_, [&](const Subscriber& one) { return one.peer == from; }) > 0;
    return was_there ? ControlAnswer{} : ControlAnswer{{}, "there was no subscription of this port"};
}

std::vector<OscMessage> OscControl::list() const
{
    const std::vector<ControlledObject> objects = controlled_.objects();
    std::vector<OscMessage> messages;
    for (const ControlledObject& object : objects) {
        messages.push_back({fmt::format("/haptel/state/object/{}", object.number), {object.name, object.texture}});
        for (const std::string& preset : object.presets)
            messages.push_back({fmt::format("/haptel/state/object/{}/preset", object.number), {preset}});
    }
    for (OscMessage& parameter : about_parameters(objects)) messages.push_back(std::move(parameter));
    return messages;
}

std::vector<OscDatagram> OscControl::state(Clock::time_point now)
{
    std::erase_if(subscribers_, [&](const Subscriber& one) { return one.until < now; });
    std::vector<OscDatagram> datagrams;
    for (Subscriber& subscriber : subscribers_) {
        if (now < subscriber.due) continue;
        subscriber.due = std::max(subscriber.due + subscriber.interval, now); // none is made up for
        const auto add = [&](const OscMessage& message) { datagrams.push_back({subscriber.peer, write_osc(message)}); };
        add({"/haptel/state/running", {std::string(controlled_.is_force_withheld() ? "stopped" : "running")}});
        const std::vector<ControlledHand> hands = controlled_.hands();
        for (std::size_t i = 0; i < hands.size(); ++i)
            for (const OscMessage& message : about(hands[i], i + 1)) add(message);
        const uint64_t version = controlled_.objects_version();
        if (std::exchange(subscriber.version, version) == version) continue;
        for (const OscMessage& message : about_parameters(controlled_.objects())) add(message);
    }
    return datagrams;
}

std::vector<OscDatagram> OscControl::to_all(const OscMessage& message) const
{
    std::vector<OscDatagram> datagrams;
    for (const Subscriber& subscriber : subscribers_) datagrams.push_back({subscriber.peer, write_osc(message)});
    return datagrams;
}

std::vector<OscDatagram> OscControl::tell(const std::string& text) const
{
    return to_all({"/haptel/message", {lang::printable(text.substr(0, osc_bytes_max / 8))}});
}

std::vector<OscDatagram> OscControl::end(const std::string& why) const
{
    return to_all({"/haptel/state/running", {"ended: " + why}});
}

} // namespace haptel::tools
