#include "jit/live/live_texture.h"

#include "jit/live/compile_thread.h"
#include "jit/picture/image_file.h"
#include "jit/texture/source_file.h"
#include "lang/parameter_value.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <vector>

namespace haptel::jit {

namespace {

using Clock = std::chrono::steady_clock;
// Between deleting the old file and making the new one, some editors take a while.
constexpr auto absence_forgiven = std::chrono::milliseconds(500);

bool is_unreadable(const CompiledTextures& compiled)
{
    const auto& findings = compiled.diagnostics.all();
    return std::any_of(findings.begin(), findings.end(),
                       [](const lang::Diagnostic& finding) { return finding.code == "unreadable-file"; });
}

} // namespace

class LiveTexture::Client final : public CompileThread::Client {
public:
    Client(TextureRequest asked, LiveCallbacks called, LiveOptions chosen)
        : request(std::move(asked))
        , reference(split_reference(request.reference))
        , callbacks(std::move(called))
        , options(std::move(chosen))
        , in_hand(options.cache->known(reference.file))
        , thread(CompileThread::shared())
    {
        if (in_hand && in_hand->program) pictures_in_hand = pictures_of(*in_hand->program);
        thread->add(this);
    }
    ~Client() override { thread->remove(this); }

    void set_parameter(std::string name, std::string value)
    {
        {
            const std::lock_guard lock(edits_mutex);
            edits.emplace_back(std::move(name), std::move(value));
        }
        thread->wake();
    }

    void update() override;
    void failed(std::string_view why) override
    {
        report(lang::printable(reference.file) + ": error: this edit could not be taken up: " + std::string(why) +
               "; the old texture stays\n");
    }
    std::set<std::string> files() const override { return watched; }

private:
    TextureRequest request;
    const TextureReference reference;
    const LiveCallbacks callbacks;
    const LiveOptions options;

    std::shared_ptr<const CompiledTextures> in_hand; // what was looked at last; broken ones too
    std::shared_ptr<const CompiledTextures> usable;  // the last one that has a program
    struct Picture {
        std::string file;
        std::shared_ptr<const ir::SplineImage> image; // null: it cannot be read
        bool operator==(const Picture&) const = default;
    };
    std::vector<Picture> pictures_in_hand; // as of the last look
    std::optional<Clock::time_point> absent_since;
    std::string reported; // the last report, not to be repeated
    std::set<std::string> watched = {reference.file};

    std::mutex edits_mutex;
    std::vector<std::pair<std::string, std::string>> edits;

    const std::shared_ptr<CompileThread> thread;

    bool take_edits();
    const haptel_texture* texture_in(const CompiledProgram& program) const;
    std::vector<Picture> pictures_of(const CompiledProgram& program) const;
    bool is_forgiven(bool is_absent);
    TextureRequest request_for(const CompiledProgram& program, std::string& notes) const;
    void make_and_publish(const CompiledTextures& compiled);
    void report(std::string text)
    {
        if (text == reported) return;
        reported = text;
        if (callbacks.report && !text.empty()) callbacks.report(text);
    }
};

// True if a value was set. The newest value of a name counts.
bool LiveTexture::Client::take_edits()
{
    const std::lock_guard lock(edits_mutex);
    const bool any = !edits.empty();
    for (auto& [name, value] : edits) {
        auto known = std::find_if(request.parameters.begin(), request.parameters.end(),
                                  [&, &sought = name](const auto& parameter) { return parameter.first == sought; });
        if (known == request.parameters.end())
            request.parameters.emplace_back(std::move(name), std::move(value));
        else
            known->second = std::move(value);
    }
    edits.clear();
    return any;
}

// Null: the program has no such texture.
const haptel_texture* LiveTexture::Client::texture_in(const CompiledProgram& program) const
{
    return reference.texture.empty() && program.textures().size() == 1 ? &program.textures()[0]
                                                                       : program.find(reference.texture);
}

// As they are on disk now; read only where that is not what is in use.
std::vector<LiveTexture::Client::Picture> LiveTexture::Client::pictures_of(const CompiledProgram& program) const
{
    std::vector<Picture> pictures;
    const haptel_texture* texture = texture_in(program);
    if (!texture) return pictures;
    for (const ir::Parameter& parameter : program.source_of(*texture).parameters)
        for (const auto& [name, value] : request.parameters)
            if (parameter.type == ir::Type::image && name == parameter.name)
                pictures.push_back({image_file(value, request.folder), read_image(value, request.folder).image});
    return pictures;
}

// Whether what is gone may be about to come back.
bool LiveTexture::Client::is_forgiven(bool is_absent)
{
    if (!is_absent) {
        absent_since.reset();
        return false;
    }
    if (!absent_since) absent_since = Clock::now();
    return Clock::now() - *absent_since < absence_forgiven;
}

// The request without values that do not fit this program; each is noted.
TextureRequest LiveTexture::Client::request_for(const CompiledProgram& program, std::string& notes) const
{
    TextureRequest fitting = request;
    const haptel_texture* texture = texture_in(program);
    if (!texture) return fitting; // make_binding says so
    const std::vector<ir::Parameter>& known = program.source_of(*texture).parameters;
    std::erase_if(fitting.parameters, [&, &file = reference.file](const auto& parameter) {
        const auto& [name, value] = parameter;
        const auto found = std::find_if(known.begin(), known.end(),
                                        [&, &sought = name](const ir::Parameter& one) { return one.name == sought; });
        const std::string fault =
            found == known.end() ? "there is no such parameter now" : lang::parse_value(value, *found).error;
        if (!fault.empty())
            notes += lang::printable(file) + ": note: the value " + lang::printable(value) + " of '" +
                     lang::printable(name) + "' is set aside: " + fault + "\n";
        return !fault.empty();
    });
    return fitting;
}

void LiveTexture::Client::make_and_publish(const CompiledTextures& compiled)
{
    std::string said = compiled.rendered();
    const TextureRequest fitting = request_for(*compiled.program, said);
    TextureResult result = make_binding(compiled.program, reference.texture, fitting);
    said += about_file(reference.file, result.diagnostics);
    if (!result.binding) return report(said + about_file(reference.file, "note: the old texture stays"));
    callbacks.publish(std::move(*result.binding));
    report(std::move(said));
}

void LiveTexture::Client::update()
{
    const bool edited = take_edits();
    const auto compiled = options.cache->load(reference.file);
    watched.insert(compiled->files.begin(), compiled->files.end());
    watched.insert(reference.file);
    if (compiled->program) {
        std::vector<Picture> pictures = pictures_of(*compiled->program);
        for (const Picture& picture : pictures) watched.insert(picture.file);
        const bool is_absent =
            std::any_of(pictures.begin(), pictures.end(), [](const Picture& picture) { return !picture.image; });
        if (is_forgiven(is_absent) && !edited && compiled == in_hand) return;
        const bool changed = compiled != in_hand || pictures != pictures_in_hand;
        in_hand = usable = compiled;
        pictures_in_hand = std::move(pictures);
        if (changed || edited) make_and_publish(*usable);
        return;
    }
    in_hand = compiled;
    if (edited && usable) make_and_publish(*usable); // a slider works on while the file is broken
    if (is_forgiven(is_unreadable(*compiled))) return;
    report(compiled->rendered());
}

LiveTexture::LiveTexture(TextureRequest request, LiveCallbacks callbacks, LiveOptions options)
    : client(std::make_unique<Client>(std::move(request), std::move(callbacks), std::move(options)))
{
}

LiveTexture::~LiveTexture() = default;

void LiveTexture::set_parameter(std::string name, std::string value)
{
    client->set_parameter(std::move(name), std::move(value));
}

} // namespace haptel::jit
