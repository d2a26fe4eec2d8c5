#include "textures/texture_set.h"

#include <algorithm>
#include <map>
#include <mutex>

#include <fmt/format.h>

#include "base/threads.h"
#include "describe/build_apart.h"
#include "describe/nesting.h"
#include "textures/image_cache.h"

namespace alhazen {

struct TextureSet::State {
    struct Made {
        std::mutex making;
        bool is_made = false;
        std::shared_ptr<const SpectrumNode> node;
    };
    struct SpectrumEntry {
        TextureNode description;
        bool is_valid = false; ///< the check found no errors
        Vec2i image_size{0, 0};
        Made by_role[3];
    };

    std::map<std::string, std::shared_ptr<const FloatNode>> floats;
    std::map<std::string, SpectrumEntry> spectra;
    ImageCache images;
    ColorMode color_mode = ColorMode::spectral;
    std::filesystem::path base_folder;
    bool lenient = false;
    // Building a texture finds the textures it is made of.
    std::recursive_mutex mutex;
};

TextureSet::TextureSet() : state_(std::make_unique<State>()) {}
TextureSet::~TextureSet() = default;
TextureSet::TextureSet(TextureSet&&) noexcept = default;
TextureSet& TextureSet::operator=(TextureSet&&) noexcept = default;

namespace {

// What an unknown texture becomes in lenient mode.
constexpr std::string_view substitute = "constant";

template <class Family>
std::shared_ptr<const Family> make_node(const KindList<Family>& kinds, const TextureNode& description,
                                        const TextureUse& use, BuildContext& context) {
    Transform outer_transform = context.world_from_node;
    const TextureUse* outer_use = context.texture_use;
    context.world_from_node = Transform(description.world_from_texture.start);
    context.texture_use = &use;
    std::shared_ptr<const Family> node;
    if (description.node.type == "ptex") {
        // Known to scenes, but no packaged library reads its files.
        context.messages.add_unsupported(
            description.node.place,
            "textures of type \"ptex\" cannot be read; bake them into images for \"imagemap\"", substitute);
        Node plain;
        plain.type = substitute;
        if (context.messages.lenient) node = kinds.make(plain, context, substitute);
    } else {
        node = kinds.make(description.node, context, substitute);
    }
    context.world_from_node = outer_transform;
    context.texture_use = outer_use;
    return node;
}

// Reads images at the same time. They stay in the cache, for the textures that are then built in turn, and
// which tell what is wrong.
void read_images(const std::vector<TextureNode>& nodes, ImageCache& images, const BuildContext& context) {
    parallel_for(nodes.size(), 1, [&](std::size_t i) {
        if (nodes[i].node.type != "imagemap") return;
        Messages unheard;
        BuildContext own = with_messages(context, unheard);
        TextureUse use{SpectrumRole::unbounded, &images, nodes[i].is_spectrum};
        if (nodes[i].is_spectrum)
            make_node(spectrum_texture_kinds(), nodes[i], use, own);
        else
            make_node(float_texture_kinds(), nodes[i], use, own);
    });
}

} // namespace

void TextureSet::limit_memory(std::size_t bytes) {
    state_->images.limit_memory(bytes);
}

void TextureSet::build(const std::vector<TextureNode>& nodes, BuildContext& context) {
    read_images(nodes, state_->images, context);
    std::lock_guard lock(state_->mutex);
    context.textures = this;
    state_->floats.clear();
    state_->spectra.clear();
    state_->color_mode = context.color_mode;
    state_->base_folder = context.base_folder;
    state_->lenient = context.messages.lenient;
    NestingGuard nesting;
    for (const TextureNode& description : nodes) {
        const std::string& name = description.node.name;
        if (description.is_spectrum ? has_spectrum(name) : has_float(name)) {
            context.messages.add_error(description.node.place,
                                       fmt::format("the {} texture \"{}\" is already defined",
                                                   description.is_spectrum ? "spectrum" : "float", name));
            continue;
        }
        if (!nesting.add(description.node, ValueType::texture, "textures", context.messages)) {
            // It is there, but cannot be used: what names it need not complain.
            if (description.is_spectrum)
                state_->spectra[name];
            else
                state_->floats[name] = nullptr;
            continue;
        }
        if (description.is_spectrum) {
            TextureUse check{SpectrumRole::unbounded, &state_->images, true};
            auto checked = make_node(spectrum_texture_kinds(), description, check, context);
            State::SpectrumEntry& entry = state_->spectra[name];
            entry.description = description;
            entry.is_valid = checked != nullptr;
            if (checked) entry.image_size = checked->image_size();
        } else {
            TextureUse use{SpectrumRole::unbounded, &state_->images, false};
            auto node = make_node(float_texture_kinds(), description, use, context);
            state_->floats[name] = std::move(node);
        }
    }
}

void TextureSet::forget_images() {
    std::lock_guard lock(state_->mutex);
    state_->images.clear();
}

std::shared_ptr<const FloatNode> TextureSet::find_float(const std::string& name) const {
    std::lock_guard lock(state_->mutex);
    auto it = state_->floats.find(name);
    return it == state_->floats.end() ? nullptr : it->second;
}

std::shared_ptr<const SpectrumNode> TextureSet::find_spectrum(const std::string& name, SpectrumRole role,
                                                              Messages* messages) const {
    std::unique_lock lock(state_->mutex);
    auto it = state_->spectra.find(name);
    if (it == state_->spectra.end() || !it->second.is_valid) return nullptr;
    State::SpectrumEntry& entry = it->second;
    lock.unlock();
    State::Made& made = entry.by_role[static_cast<std::size_t>(role)];
    std::lock_guard making(made.making);
    if (!made.is_made) {
        // Warnings came with the check; only errors are new.
        Messages found;
        found.lenient = state_->lenient;
        BuildContext context{found, state_->color_mode, state_->base_folder, this};
        TextureUse use{role, &state_->images, false};
        made.node = make_node(spectrum_texture_kinds(), entry.description, use, context);
        made.is_made = true;
        for (const Message& m : found.list())
            if (messages && m.kind == Message::Kind::error) messages->add_error(m.place, m.text);
    }
    return made.node;
}

bool TextureSet::has_float(const std::string& name) const {
    std::lock_guard lock(state_->mutex);
    return state_->floats.count(name) != 0;
}
bool TextureSet::has_spectrum(const std::string& name) const {
    std::lock_guard lock(state_->mutex);
    return state_->spectra.count(name) != 0;
}

std::optional<Vec2i> TextureSet::image_size(const std::string& name) const {
    std::lock_guard lock(state_->mutex);
    Vec2i size{0, 0};
    if (auto it = state_->spectra.find(name); it != state_->spectra.end()) size = it->second.image_size;
    if (auto it = state_->floats.find(name); it != state_->floats.end() && it->second)
        size = it->second->image_size();
    if (size.x == 0) return std::nullopt;
    return size;
}

std::size_t TextureSet::bytes() const {
    std::lock_guard lock(state_->mutex);
    return state_->images.bytes();
}

TextureMemory TextureSet::memory() const {
    return state_->images.memory();
}

void TextureSet::throw_if_failed() const {
    state_->images.throw_if_failed();
}

std::vector<std::string> TextureSet::float_names() const {
    std::lock_guard lock(state_->mutex);
    std::vector<std::string> names;
    for (const auto& [name, node] : state_->floats) names.push_back(name);
    return names;
}
std::vector<std::string> TextureSet::spectrum_names() const {
    std::lock_guard lock(state_->mutex);
    std::vector<std::string> names;
    for (const auto& [name, entry] : state_->spectra) names.push_back(name);
    return names;
}

} // namespace alhazen
