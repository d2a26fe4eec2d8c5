/// OpenEXR files through the OpenEXR library (Kainz et al. 2009): scanline or tiled, any channels, read as
/// floats and written as half or float with ZIP compression.
#include <algorithm>
#include <cstring>
#include <stdexcept>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <half.h>

#include "image/formats.h"

namespace alhazen {

namespace {

class MemoryInput : public Imf::IStream {
  public:
    explicit MemoryInput(std::string_view bytes) : Imf::IStream("memory"), bytes_(bytes) {}
    bool read(char c[], int n) override {
        auto count = static_cast<std::size_t>(n);
        if (n < 0 || position_ > bytes_.size() || count > bytes_.size() - position_)
            throw std::runtime_error("the file ends too early");
        std::memcpy(c, bytes_.data() + position_, count);
        position_ += count;
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t pos) override { position_ = pos; }

  private:
    std::string_view bytes_;
    std::size_t position_ = 0;
};

class MemoryOutput : public Imf::OStream {
  public:
    MemoryOutput() : Imf::OStream("memory") {}
    void write(const char c[], int n) override {
        auto count = static_cast<std::size_t>(n);
        if (bytes.size() < position_ + count) bytes.resize(position_ + count);
        std::memcpy(bytes.data() + position_, c, count);
        position_ += count;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t pos) override { position_ = pos; }

    std::string bytes;

  private:
    std::size_t position_ = 0;
};

/// Layers stay together, the unnamed one first; in each R G B A, then the rest as in the file. Grey (Y)
/// stands before A; X goes with Y.
std::pair<std::string, int> order_of(const std::string& name) {
    std::size_t dot = name.rfind('.');
    std::string layer = dot == std::string::npos ? "" : name.substr(0, dot);
    std::string channel = dot == std::string::npos ? name : name.substr(dot + 1);
    constexpr std::string_view known = "RGBXYA";
    std::size_t rank = channel.size() == 1 ? known.find(channel[0]) : std::string_view::npos;
    return {layer, static_cast<int>(std::min(rank, known.size()))};
}

std::vector<std::string> channel_names(const Imf::Header& header) {
    std::vector<std::string> names;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
            throw std::runtime_error(fmt::format(
                "EXR channel \"{}\" is subsampled (luminance and chroma), which is not supported", c.name()));
        names.emplace_back(c.name());
    }
    std::stable_sort(names.begin(), names.end(),
                     [](const std::string& a, const std::string& b) { return order_of(a) < order_of(b); });
    return names;
}

Imf::Slice slice(Imf::PixelType type, const void* first, const Imath::Box2i& window,
                 std::size_t pixel_bytes) {
    auto row_bytes = pixel_bytes * static_cast<std::size_t>(window.max.x - window.min.x + 1);
    return Imf::Slice::Make(type, first, window, pixel_bytes, row_bytes);
}

Rect2i to_rect(const Imath::Box2i& box) {
    return {{box.min.x, box.min.y}, {box.max.x + 1, box.max.y + 1}};
}

/// The space by the file's chromaticities. Those of none that has a name: the colours become sRGB's.
void set_color_space(const Imf::Header& header, Image& image) {
    if (!Imf::hasChromaticities(header)) return;
    const Imf::Chromaticities& c = Imf::chromaticities(header);
    auto distance = [](const Imath::V2f& a, Vec2d b) {
        return std::hypot(static_cast<double>(a.x) - b.x, static_cast<double>(a.y) - b.y);
    };
    constexpr double near = 2e-3; // files round what standards say
    for (const std::string& name : color_space_names()) {
        const RgbColorSpace& space = *find_color_space(name);
        if (distance(c.red, space.red) > near || distance(c.green, space.green) > near ||
            distance(c.blue, space.blue) > near || distance(c.white, space.white) > near)
            continue;
        image.info.metadata.erase("color_space");
        if (&space != &srgb_space()) image.info.metadata["color_space"] = space.name;
        return;
    }
    if (!image.has_rgb()) return;
    const Imath::M44f to_xyz = Imf::RGBtoXYZ(c, 1);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Vec3 rgb = image.rgb(x, y);
            const Imath::V3f xyz = Imath::V3f(rgb.x, rgb.y, rgb.z) * to_xyz;
            image.set_rgb(x, y, srgb_space().from_xyz({xyz.x, xyz.y, xyz.z}));
        }
}

Image read_pixels(Imf::InputFile& file) {
    const Imf::Header& header = file.header();
    const Imath::Box2i& window = header.dataWindow();
    Rect2i data = to_rect(window);
    Image image(data.width(), data.height(), channel_names(header));
    Imf::FrameBuffer buffer;
    auto pixel_bytes = static_cast<std::size_t>(image.channels()) * sizeof(float);
    for (std::size_t c = 0; c < image.channel_names().size(); ++c)
        buffer.insert(image.channel_names()[c],
                      slice(Imf::FLOAT, image.values().data() + c, window, pixel_bytes));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    image.info.origin = data.lo;
    image.info.display_window = to_rect(header.displayWindow());
    bool half_floats = header.channels().begin().channel().type == Imf::HALF;
    image.info.bits = half_floats ? 16 : 32;
    for (auto a = header.begin(); a != header.end(); ++a) {
        std::string_view name = a.name(), type = a.attribute().typeName();
        if (type != "string" || name == "type" || name == "name") continue;
        image.info.metadata[a.name()] = static_cast<const Imf::StringAttribute&>(a.attribute()).value();
    }
    set_color_space(header, image);
    return image;
}

void insert_metadata(Imf::Header& header, const Image& image, const WriteOptions& options) {
    auto metadata = options.metadata;
    metadata.insert(image.info.metadata.begin(), image.info.metadata.end());
    for (const auto& [name, value] : metadata) {
        if (name.empty() || name.size() > 255)
            throw std::runtime_error("names of EXR attributes must have 1 to 255 bytes");
        if (header.find(name) != header.end())
            throw std::runtime_error(fmt::format("EXR attribute \"{}\" is reserved", name));
        header.insert(name, Imf::StringAttribute(value));
    }
}

/// The primaries and white of the picture's colour space, where it is another than the one that files without
/// this attribute have (OpenEXR's documentation, "Standard Attributes").
void insert_chromaticities(Imf::Header& header, const Image& image, const WriteOptions& options) {
    const RgbColorSpace* space = color_space_of(image, options);
    if (!space || space == &srgb_space()) return;
    auto xy = [](Vec2d p) { return Imath::V2f(static_cast<float>(p.x), static_cast<float>(p.y)); };
    Imf::addChromaticities(header, {xy(space->red), xy(space->green), xy(space->blue), xy(space->white)});
}

/// Finite values stay finite: half floats end at 65504.
std::vector<half> to_half(std::span<const float> values) {
    std::vector<half> out(values.size());
    std::transform(values.begin(), values.end(), out.begin(),
                   [](float v) { return half(std::isfinite(v) ? std::clamp(v, -65504.0f, 65504.0f) : v); });
    return out;
}

std::string write_pixels(const Image& image, const WriteOptions& options) {
    Vec2i lo = image.info.origin, hi = lo + image.size();
    Rect2i display = image.info.display_window.empty() ? Rect2i{lo, hi} : image.info.display_window;
    Imath::Box2i window({lo.x, lo.y}, {hi.x - 1, hi.y - 1});
    Imf::Header header(Imath::Box2i({display.lo.x, display.lo.y}, {display.hi.x - 1, display.hi.y - 1}),
                       window);
    header.compression() = Imf::ZIP_COMPRESSION;
    insert_chromaticities(header, image, options);
    insert_metadata(header, image, options);
    bool halves = options.depth == FloatDepth::half;
    std::vector<half> converted = halves ? to_half(image.values()) : std::vector<half>{};
    auto type = halves ? Imf::HALF : Imf::FLOAT;
    std::size_t bytes = halves ? sizeof(half) : sizeof(float);
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < image.channel_names().size(); ++c) {
        const std::string& name = image.channel_names()[c];
        const void* first =
            halves ? static_cast<const void*>(converted.data() + c) : image.values().data() + c;
        header.channels().insert(name, Imf::Channel(type));
        buffer.insert(name, slice(type, first, window, bytes * image.channel_names().size()));
    }
    MemoryOutput out;
    {
        Imf::OutputFile file(out, header, 0);
        file.setFrameBuffer(buffer);
        file.writePixels(image.height());
    }
    return std::move(out.bytes);
}

} // namespace

Image decode_exr(std::string_view bytes) {
    check_exr_header(bytes);
    try {
        MemoryInput stream(bytes);
        Imf::InputFile file(stream, 0);
        if (!file.isComplete()) throw std::runtime_error("truncated EXR file: pixels are missing");
        return read_pixels(file);
    } catch (const std::runtime_error& error) {
        // The library's own exceptions derive from runtime_error too; theirs do not say that it is EXR.
        if (std::string_view(error.what()).find("EXR") != std::string_view::npos)
            throw std::runtime_error(error.what());
        throw std::runtime_error(fmt::format("corrupt EXR file: {}", error.what()));
    } catch (const std::exception& error) {
        throw std::runtime_error(fmt::format("corrupt EXR file: {}", error.what()));
    }
}

std::string encode_exr(const Image& image, const WriteOptions& options) {
    try {
        return write_pixels(image, options);
    } catch (const std::exception& error) {
        throw std::runtime_error(fmt::format("cannot write EXR: {}", error.what()));
    }
}

} // namespace alhazen
