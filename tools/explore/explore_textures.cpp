#include "tools/explore/explore_textures.h"

#include "jit/live/live_texture.h"
#include "jit/texture/resolver.h"
#include "jit/texture/source_file.h"
#include "lang/parameter_value.h"
#include "lang/text/near_name.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <span>
#include <utility>

namespace haptel::tools {

namespace {

using Values = std::vector<std::pair<std::string, std::string>>; // as written

// As a scene file has it.
std::string value_text(const ir::Parameter& parameter)
{
    if (parameter.type == ir::Type::boolean) return parameter.value != 0 ? "true" : "false";
    return fmt::format("{}", parameter.value);
}

// That a binding runs with.
std::vector<double> parameter_values(const TextureBinding& binding)
{
    std::vector<double> values;
    const auto held = [&]<typename Held>(const haptel_parameter& parameter, Held value) {
        std::memcpy(&value, static_cast<const char*>(binding.block) + parameter.offset, sizeof value);
        return static_cast<double>(value);
    };
    for (const haptel_parameter& parameter : std::span(binding.texture->parameters, binding.texture->parameter_count)) {
        if (parameter.type == HAPTEL_FLOAT)
            values.push_back(held(parameter, double{}));
        else if (parameter.type == HAPTEL_UINT)
            values.push_back(held(parameter, uint32_t{}));
        else
            values.push_back(parameter.type == HAPTEL_IMAGE ? 0 : held(parameter, int32_t{}));
    }
    return values;
}

// The same parameters, whatever their defaults: the values of one fit the other.
bool is_alike(const ir::Texture& one, const ir::Texture& other)
{
    return std::ranges::equal(one.parameters, other.parameters, [](const auto& a, const auto& b) {
        return a.name == b.name && a.type == b.type && a.unit == b.unit && a.choices == b.choices;
    });
}

std::string meant_or_all(std::string_view name, const std::vector<std::string>& names)
{
    const std::string_view meant = near_name(name, {names.begin(), names.end()}).name;
    if (!meant.empty()) return fmt::format("did you mean '{}'?", meant);
    return names.empty() ? "it has none" : fmt::format("it has {}", fmt::join(names, ", "));
}

} // namespace

struct ExploreTextures::Watcher {
    uint32_t object = 0; // its number in the scene, from 1
    std::string name;    // of the texture; empty: the only one of its file
    std::string file;
    Values written; // in the scene
    std::mutex felt_mutex;
    std::vector<double> felt;          // by parameter; empty: nothing was published yet
    std::vector<ir::Texture> textures; // of the file, when it compiled last: what names and values are held against
    std::atomic<bool> is_compiled_anew{true};
    std::unique_ptr<jit::LiveTexture> texture;

    // Null: the texture's name is gone from the file.
    const ir::Texture* find(std::string_view wanted) const
    {
        if (wanted.empty()) return textures.size() == 1 ? textures.data() : nullptr;
        const auto found = std::ranges::find(textures, wanted, &ir::Texture::name);
        return found == textures.end() ? nullptr : &*found;
    }

    const ir::Texture* up_to_date()
    {
        if (is_compiled_anew.exchange(false))
            if (const auto compiled = jit::ProgramCache::shared()->known(file); compiled && compiled->program)
                textures = compiled->program->module().textures;
        return find(name);
    }

    void keep(std::vector<double> values)
    {
        const std::lock_guard lock(felt_mutex);
        felt = std::move(values);
    }

    // By parameter: of the binding that was published last, or what the scene said.
    std::vector<double> values_of(const ir::Texture& now)
    {
        {
            const std::lock_guard lock(felt_mutex);
            if (felt.size() == now.parameters.size()) return felt;
        }
        std::vector<double> values;
        for (const ir::Parameter& parameter : now.parameters) values.push_back(parameter.value);
        for (const auto& [set, text] : written) {
            const lang::ParameterValues read = lang::parse_values(set, text, now);
            for (std::size_t i = 0; i < read.values.size() && read.values[i].error.empty(); ++i)
                values[static_cast<std::size_t>(&read.parameters[i] - now.parameters.data())] = read.values[i].value;
        }
        return values;
    }
};

ExploreTextures::ExploreTextures() = default;
ExploreTextures::~ExploreTextures() = default;

TextureResolver ExploreTextures::resolver()
{
    return [this, compile = jit::make_resolver()](const TextureRequest& request) {
        TextureResult result = compile(request);
        if (result.binding) compiled_.fetch_add(1, std::memory_order_relaxed);
        return result;
    };
}

void ExploreTextures::watch(const runtime::Scene& scene)
{
    std::vector<std::unique_ptr<Watcher>> watchers;
    std::vector<std::string> names;
    for (const runtime::SceneObject& object : scene.objects) {
        names.push_back(object.name);
        if (!object.request) continue;
        auto& watcher = *watchers.emplace_back(std::make_unique<Watcher>());
        jit::TextureReference reference = jit::split_reference(object.request->reference, object.request->folder);
        watcher.object = static_cast<uint32_t>(names.size());
        watcher.name = std::move(reference.texture);
        watcher.file = std::move(reference.file);
        watcher.written = object.request->parameters;
        const auto publish = [this, &watcher, name = object.request->reference,
                              slot = object.texture](TextureBinding binding, bool is_said) {
            std::vector<double> values = parameter_values(binding);
            const std::string fault = slot->publish(std::move(binding));
            if (!fault.empty()) return say(name + ": not used: " + fault + "\n");
            watcher.keep(std::move(values));
            if (is_said) say(name + ": reloaded\n");
            version_.fetch_add(1, std::memory_order_release);
        };
        jit::LiveCallbacks callbacks;
        callbacks.publish = [this, publish, &watcher](TextureBinding binding) {
            compiled_.fetch_add(1, std::memory_order_relaxed);
            watcher.is_compiled_anew = true;
            publish(std::move(binding), true);
        };
        callbacks.publish_values = [publish](TextureBinding binding) { publish(std::move(binding), false); };
        callbacks.report = [this](std::string_view diagnostics) { say(std::string(diagnostics)); };
        watcher.texture = std::make_unique<jit::LiveTexture>(*object.request, std::move(callbacks));
    }
    {
        const std::lock_guard lock(watchers_mutex_);
        watchers_.swap(watchers);
        names_.swap(names);
    }
    version_.fetch_add(1, std::memory_order_release);
}

ExploreTextures::Watcher* ExploreTextures::watcher_of(uint32_t object, std::string& refused) const
{
    const auto found = std::ranges::find_if(watchers_, [&](const auto& one) { return one->object == object; });
    if (found != watchers_.end()) return found->get();
    refused = object <= names_.size()
                  ? fmt::format("object {} ({}) has no texture", object, lang::printable(names_[object - 1]))
                  : fmt::format("expected an object from 1 to {}, found {}", names_.size(), object);
    return nullptr;
}

ControlAnswer ExploreTextures::set(uint32_t object, const std::string& parameter, const std::string& value)
{
    const std::lock_guard lock(watchers_mutex_);
    ControlAnswer answer;
    Watcher* const watcher = watcher_of(object, answer.refused);
    if (!watcher) return answer;
    const ir::Texture* const texture = watcher->up_to_date();
    if (!texture) return {fmt::format("the file has no texture '{}' now: mend it first", watcher->name), {}};
    const lang::ParameterValues read = lang::parse_values(parameter, value, *texture);
    if (read.parameters.empty())
        return {fmt::format("texture '{}' has no parameter '{}': {}", texture->name, lang::printable(parameter),
                            meant_or_all(parameter, lang::parameter_names(*texture))),
                {}};
    if (read.parameters.front().type == ir::Type::image)
        return {fmt::format("'{}' is a picture: set it in the scene file", parameter), {}};
    for (const lang::ParameterValue& one : read.values) {
        if (!one.error.empty()) return {one.error + (one.hint.empty() ? "" : "; " + one.hint), {}};
        if (!one.warning.empty()) answer.remark = one.warning;
    }
    watcher->texture->set_parameter(parameter, value);
    return answer;
}

ControlAnswer ExploreTextures::choose_preset(uint32_t object, const std::string& name)
{
    const std::lock_guard lock(watchers_mutex_);
    ControlAnswer answer;
    Watcher* const watcher = watcher_of(object, answer.refused);
    if (!watcher) return answer;
    const ir::Texture* const texture = watcher->up_to_date();
    if (!texture) return {fmt::format("the file has no texture '{}' now: mend it first", watcher->name), {}};
    const ir::Texture* const preset = name.empty() ? nullptr : watcher->find(name);
    if (!preset || !is_alike(*texture, *preset)) {
        std::vector<std::string> names;
        for (const ir::Texture& one : watcher->textures)
            if (is_alike(*texture, one)) names.push_back(one.name);
        return {fmt::format("texture '{}' has no preset '{}': {}", texture->name, lang::printable(name),
                            meant_or_all(name, names)),
                {}};
    }
    Values values;
    for (const ir::Parameter& parameter : preset->parameters)
        if (parameter.type != ir::Type::image) values.emplace_back(parameter.name, value_text(parameter));
    watcher->texture->set_parameters(std::move(values));
    return answer;
}

std::vector<ControlledObject> ExploreTextures::controlled() const
{
    const std::lock_guard lock(watchers_mutex_);
    std::vector<ControlledObject> objects;
    for (std::size_t i = 0; i < names_.size(); ++i)
        objects.push_back({static_cast<uint32_t>(i + 1), names_[i], {}, {}, {}});
    for (const auto& watcher : watchers_) {
        const ir::Texture* const texture = watcher->up_to_date();
        if (!texture) continue;
        ControlledObject& object = objects[watcher->object - 1];
        object.texture = texture->name;
        const std::vector<double> values = watcher->values_of(*texture);
        for (std::size_t i = 0; i < values.size(); ++i)
            if (texture->parameters[i].type != ir::Type::image)
                object.parameters.emplace_back(texture->parameters[i].name, values[i]);
        for (const ir::Texture& one : watcher->textures)
            if (is_alike(*texture, one)) object.presets.push_back(one.name);
    }
    return objects;
}

std::string ExploreTextures::take_messages()
{
    const std::lock_guard lock(messages_mutex_);
    return std::exchange(messages_, {});
}

void ExploreTextures::say(const std::string& message)
{
    const std::lock_guard lock(messages_mutex_);
    messages_ += message;
}

} // namespace haptel::tools
