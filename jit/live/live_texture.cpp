#include "jit/live/live_texture.h"

#include "jit/live/compile_thread.h"
#include "jit/picture/image_file.h"
#include "jit/texture/source_file.h"
#include "lang/parameter_value.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <vector>

namespace haptel::jit {

namespace {

using namespace std::chrono_literals;
using Clock = CompileThread::Clock;

// A value is felt at once, and by a range of heights that takes longer to find when none has come for so long: each
// would be late that came meanwhile, or while that range fades in. A wheel that is turned clicks more often.
constexpr auto rest = 500ms;
// Between deleting the old file and making the new one, some editors take a while.
constexpr auto absence_forgiven = 500ms;

struct UsedPicture {
    std::string file;
    std::shared_ptr<const ir::SplineImage> image; // null: it cannot be read
    bool operator==(const UsedPicture&) const = default;
};

bool is_same_range(const TextureBinding& one, const TextureBinding& other)
{
    return one.facts.height_min_m == other.facts.height_min_m && one.facts.height_max_m == other.facts.height_max_m &&
           std::ranges::equal(one.shoulder_m, other.shoulder_m);
}

} // namespace

class LiveTexture::Client {
public:
    Client(TextureRequest asked, LiveCallbacks called, LiveOptions options)
        : request(std::move(asked))
        , reference(split_reference(request.reference, request.folder))
        , callbacks(std::move(called))
        , cache(std::move(options.cache))
        , in_hand(cache->known(reference.file))
        , thread(CompileThread::shared())
    {
        if (in_hand && in_hand->program) pictures_in_hand = pictures_of(*in_hand->program);
        place->watched = {reference.file};
        place->update = [this](CompileThread::Round& round) { update(round); };
        place->due = Clock::now(); // to know the range of what is in the hand
        thread->add(place);
    }
    ~Client()
    {
        const std::lock_guard lock(place->at_work); // waits while there is an update
        place->update = nullptr;
    }

    void set_parameters(std::vector<std::pair<std::string, std::string>> values)
    {
        {
            const std::lock_guard lock(edits_mutex);
            for (auto& [name, value] : values) {
                std::erase_if(edits, [&](const auto& known) { return known.first == name; }); // the newest counts
                edits.emplace_back(std::move(name), std::move(value));
            }
        }
        thread->wake();
    }

private:
    // True if a value was set. The newest value of a name counts.
    bool take_edits()
    {
        const std::lock_guard lock(edits_mutex);
        if (!edits.empty()) parameters_before = request.parameters;
        for (auto& edit : edits) {
            std::erase_if(request.parameters, [&](const auto& known) { return known.first == edit.first; });
            request.parameters.push_back(std::move(edit));
        }
        return !std::exchange(edits, {}).empty();
    }

    // As they are on disk now; read only where that is not what is in use.
    std::vector<UsedPicture> pictures_of(const CompiledProgram& program) const
    {
        std::vector<UsedPicture> pictures;
        const haptel_texture* texture = program.find(reference.texture);
        if (!texture) return pictures;
        const ir::ImageParts parts = ir::parts_read(program.module());
        for (const ir::Parameter& parameter : program.source_of(*texture).parameters)
            for (const auto& [name, value] : request.parameters)
                if (parameter.type == ir::Type::image && name == parameter.name)
                    pictures.push_back(
                        {image_file(value, request.folder), read_image(value, request.folder, parts).image});
        return pictures;
    }

    // Whether what is gone may be about to come back.
    bool is_forgiven(bool is_absent)
    {
        if (!is_absent) {
            absent_since.reset();
            return false;
        }
        if (!absent_since) absent_since = Clock::now();
        return Clock::now() - *absent_since < absence_forgiven;
    }

    // The request without values that do not fit this program; each is noted.
    TextureRequest request_for(const CompiledProgram& program, std::string& notes) const
    {
        TextureRequest fitting = request;
        const haptel_texture* texture = program.find(reference.texture);
        if (!texture) return fitting; // make_binding says so
        const ir::Texture& source = program.source_of(*texture);
        std::erase_if(fitting.parameters, [&](const auto& parameter) {
            const auto& [name, value] = parameter;
            const lang::ParameterValues read = lang::parse_values(name, value, source);
            const std::string fault =
                read.parameters.empty() ? "there is no such parameter now" : read.values.front().error;
            if (!fault.empty())
                notes += lang::printable(reference.file) + ": note: the value " + lang::printable(value) + " of '" +
                         lang::printable(name) + "' is set aside: " + fault + "\n";
            return !fault.empty();
        });
        return fitting;
    }

    void make_and_publish(bool of_values_alone)
    {
        std::string said = usable->rendered();
        const TextureRequest fitting = request_for(*usable->program, said);
        const auto program = program_of(usable);
        if (!of_values_alone) complete.reset(), at_once.reset(), place->due.reset();
        TextureResult result;
        if (complete) result = make_binding_at_once(program, reference.texture, fitting, *complete);
        const bool is_at_once = result.binding.has_value();
        if (is_at_once) {
            at_once = result.binding;
            place->due = Clock::now() + rest;
        } else if (result.diagnostics.empty()) {
            result = make_binding(program, reference.texture, fitting);
            if (result.binding) complete = result.binding, at_once.reset(), place->due.reset();
        }
        said += about_file(reference.file, result.diagnostics);
        if (!result.binding) {
            if (of_values_alone) request.parameters = parameters_before; // or the next value would be refused with them
            return report(said + about_file(reference.file, "note: the old texture stays"));
        }
        if (of_values_alone && callbacks.publish_values) return callbacks.publish_values(std::move(*result.binding));
        callbacks.publish(std::move(*result.binding));
        if (!is_at_once) report(std::move(said)); // else with the range, of which there may be something to say
    }

    // Finds the range of heights with patience: what is in the hand has another where it was made at once.
    void complete_range()
    {
        place->due.reset();
        if (!usable) return;
        std::string said = usable->rendered();
        const TextureRequest fitting = request_for(*usable->program, said);
        const TextureResult result = make_binding(program_of(usable), reference.texture, fitting);
        complete = result.binding;
        const std::optional<TextureBinding> felt = std::exchange(at_once, std::nullopt);
        if (!felt) return;
        if (!callbacks.publish_values) report(said + about_file(reference.file, result.diagnostics));
        if (!complete || is_same_range(*felt, *complete)) return;
        (callbacks.publish_values ? callbacks.publish_values : callbacks.publish)(*complete);
    }

    void report(std::string text)
    {
        if (text == reported) return;
        reported = std::move(text);
        if (callbacks.report && !reported.empty()) callbacks.report(reported);
    }

    // What the file is made of now, and was made of when it compiled last: no more, however often its imports change.
    void watch(const CompiledTextures& compiled)
    {
        place->watched = {reference.file};
        place->watched.insert(compiled.files.begin(), compiled.files.end());
        if (usable) place->watched.insert(usable->files.begin(), usable->files.end());
        for (const UsedPicture& picture : pictures_in_hand) place->watched.insert(picture.file);
    }

    void follow(CompileThread::Round& round)
    {
        // A value needs no look at the files, but a binding reads pictures, which may be half written.
        const bool looks = round.of_files || !has_looked || !in_hand;
        if (round.is_writing && (looks || !pictures_in_hand.empty())) return;
        const bool edited = take_edits(),
                   is_at_rest = round.may_take_long && !edited && place->due && *place->due <= Clock::now();
        if (is_at_rest) {
            place->due = Clock::now() + rest; // if it does not come to it now
            round.may_take_long = false;
        }
        const auto compiled = looks ? cache->load(reference.file) : in_hand;
        has_looked = true;
        watch(*compiled);
        if (!compiled->program) {
            in_hand = compiled;
            if (edited && usable) make_and_publish(true); // a slider works on while the file is broken
            if (is_at_rest) complete_range();
            if (looks && !is_forgiven(compiled->has_finding("unreadable-file"))) report(compiled->rendered());
            return;
        }
        std::vector<UsedPicture> pictures = pictures_of(*compiled->program);
        for (const UsedPicture& picture : pictures) place->watched.insert(picture.file);
        const bool is_absent = std::ranges::find(pictures, nullptr, &UsedPicture::image) != pictures.end();
        if (is_forgiven(is_absent) && !edited && compiled == in_hand) return;
        const bool changed = compiled != in_hand || pictures != pictures_in_hand;
        in_hand = usable = compiled;
        pictures_in_hand = std::move(pictures);
        if (changed || edited)
            make_and_publish(!changed);
        else if (is_at_rest)
            complete_range();
    }

    void failed(std::string_view why) noexcept
    try {
        report(lang::printable(reference.file) + ": error: this edit could not be taken up: " + std::string(why) +
               "; the old texture stays\n");
    } catch (...) {
        // Not even telling went well.
    }

    // Nothing that happens here may end the thread, and with it the process and the force in somebody's hand.
    void update(CompileThread::Round& round) noexcept
    try {
        follow(round);
    } catch (const std::exception& problem) {
        failed(problem.what());
    } catch (...) {
        failed("for a reason that has no words");
    }

    TextureRequest request;
    const TextureReference reference;
    const LiveCallbacks callbacks;
    const std::shared_ptr<ProgramCache> cache;

    bool has_looked = false;                         // at the files
    std::shared_ptr<const CompiledTextures> in_hand; // what was looked at last; broken ones too
    std::shared_ptr<const CompiledTextures> usable;  // the last one that has a program
    std::vector<UsedPicture> pictures_in_hand;       // as of the last look
    // Of `usable`, with a range found with patience: of the values of now or, where at_once is set, of earlier ones.
    std::optional<TextureBinding> complete;
    std::optional<TextureBinding> at_once; // what is felt now, where its range is still to be completed
    std::optional<Clock::time_point> absent_since;
    std::string reported; // the last report, not to be repeated

    std::mutex edits_mutex;
    std::vector<std::pair<std::string, std::string>> edits;
    std::vector<std::pair<std::string, std::string>> parameters_before; // of the request, the last edits

    const std::shared_ptr<CompileThread> thread;
    const std::shared_ptr<CompileThread::Place> place = std::make_shared<CompileThread::Place>();
};

LiveTexture::LiveTexture(TextureRequest request, LiveCallbacks callbacks, LiveOptions options)
    : client(std::make_unique<Client>(std::move(request), std::move(callbacks), std::move(options)))
{
}

LiveTexture::~LiveTexture() = default;

void LiveTexture::set_parameter(std::string name, std::string value)
{
    std::vector<std::pair<std::string, std::string>> one;
    one.emplace_back(std::move(name), std::move(value));
    client->set_parameters(std::move(one));
}

void LiveTexture::set_parameters(std::vector<std::pair<std::string, std::string>> values)
{
    client->set_parameters(std::move(values));
}

} // namespace haptel::jit
