#include "materials/tensor_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>

namespace alhazen {

namespace {

struct TypeName {
    std::string_view name;
    std::size_t bytes;
};
constexpr std::array<TypeName, 12> types{{{"nothing", 0},
                                          {"uint8", 1},
                                          {"int8", 1},
                                          {"uint16", 2},
                                          {"int16", 2},
                                          {"uint32", 4},
                                          {"int32", 4},
                                          {"uint64", 8},
                                          {"int64", 8},
                                          {"float16", 2},
                                          {"float32", 4},
                                          {"float64", 8}}};

[[noreturn]] void fail(const std::string& text) {
    throw std::runtime_error(text);
}
[[noreturn]] void fail(const std::string& field, const std::string& text) {
    fail(fmt::format("field \"{}\" {}", field, text));
}

/// Reads the header from its start to its end.
class Cursor {
  public:
    explicit Cursor(std::string_view bytes) : bytes_(bytes) {}

    template <class T>
    T number() {
        T value{};
        std::memcpy(&value, text(sizeof(T)).data(), sizeof(T));
        return value;
    }
    std::string_view text(std::size_t size) {
        if (size > bytes_.size() - at_) fail("the file ends within its header");
        at_ += size;
        return bytes_.substr(at_ - size, size);
    }

  private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

Tensor read_field(const std::string& name, Cursor& header, std::string_view file) {
    const auto dimensions = header.number<std::uint16_t>();
    const auto type = header.number<std::uint8_t>();
    const auto offset = header.number<std::uint64_t>();
    if (type == 0 || type >= types.size()) fail(name, fmt::format("has the unknown type {}", type));
    Tensor field;
    field.type = static_cast<Tensor::Type>(type);
    std::uint64_t size = types[type].bytes;
    for (int i = 0; i < dimensions; ++i) {
        const auto n = header.number<std::uint64_t>();
        field.shape.push_back(n);
        // Against the file's size at each step, so that the product cannot overflow.
        if (n > 0 && size > file.size() / n) fail(name, "is larger than the file");
        size *= n;
    }
    if (offset > file.size() || size > file.size() - offset) fail(name, "goes beyond the end of the file");
    field.bytes = file.substr(offset, size);
    return field;
}

} // namespace

std::string Tensor::shape_text() const {
    std::string text;
    for (std::size_t n : shape) text += fmt::format("{}{}", text.empty() ? "" : " x ", n);
    return text.empty() ? "a single value" : text;
}

TensorFile::TensorFile(std::string bytes) : bytes_(std::move(bytes)) {
    using namespace std::string_view_literals;
    constexpr std::string_view magic = "tensor_file\0"sv;
    if (!std::string_view(bytes_).starts_with(magic)) fail("not a tensor file; expected \"tensor_file\"");
    Cursor header(bytes_);
    header.text(magic.size());
    const auto major = header.number<std::uint8_t>(), minor = header.number<std::uint8_t>();
    if (major != 1 || minor != 0)
        fail(fmt::format("unknown version {}.{} of tensor files; expected 1.0", major, minor));
    const auto count = header.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto length = header.number<std::uint16_t>();
        const std::string name(header.text(length));
        if (!fields_.emplace(name, read_field(name, header, bytes_)).second) fail(name, "is there twice");
    }
}

const Tensor* TensorFile::find(const std::string& name) const {
    const auto it = fields_.find(name);
    return it == fields_.end() ? nullptr : &it->second;
}

const Tensor& TensorFile::floats(const std::string& name, std::size_t dimensions) const {
    const Tensor* field = find(name);
    if (!field) fail(name, "is missing");
    if (field->type != Tensor::Type::float32)
        fail(name, fmt::format("is of {}, but must be of float32",
                               types[static_cast<std::size_t>(field->type)].name));
    if (field->shape.size() != dimensions)
        fail(name, fmt::format("has {} dimensions, but must have {}", field->shape.size(), dimensions));
    if (std::count(field->shape.begin(), field->shape.end(), std::size_t{0}) > 0) fail(name, "is empty");
    return *field;
}

std::vector<float> TensorFile::values(const std::string& name, std::size_t dimensions) const {
    const Tensor& field = floats(name, dimensions);
    std::vector<float> values(field.bytes.size() / sizeof(float));
    std::memcpy(values.data(), field.bytes.data(), values.size() * sizeof(float));
    const auto wrong =
        std::find_if_not(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
    if (wrong != values.end()) fail(name, fmt::format("holds {}; its values must be finite", *wrong));
    return values;
}

} // namespace alhazen
