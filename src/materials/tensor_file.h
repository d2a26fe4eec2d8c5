/// Files of named arrays, in the format that Dupuy and Jakob publish measured materials in (2018, "An
/// adaptive parameterization for efficient material acquisition and rendering"): "tensor_file", a version,
/// and for each field its name, type, place and size along each dimension; little-endian.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace alhazen {

/// One field of a file.
struct Tensor {
    /// As numbered in the file.
    enum class Type : std::uint8_t {
        uint8 = 1,
        int8,
        uint16,
        int16,
        uint32,
        int32,
        uint64,
        int64,
        float16,
        float32,
        float64,
    };
    Type type = Type::uint8;
    std::vector<std::size_t> shape;
    std::string_view bytes;

    /// "2 x 8 x 32".
    std::string shape_text() const;
};

/// A file read whole. All functions throw std::runtime_error that says what is wrong with which field.
class TensorFile {
  public:
    explicit TensorFile(std::string bytes);
    TensorFile(const TensorFile&) = delete;
    TensorFile& operator=(const TensorFile&) = delete;

    /// nullptr when there is no field of that name.
    const Tensor* find(const std::string& name) const;
    /// A field that must be there, of float32, with so many dimensions, none of them empty.
    const Tensor& floats(const std::string& name, std::size_t dimensions) const;
    /// Its values, all of which must be finite.
    std::vector<float> values(const std::string& name, std::size_t dimensions) const;

  private:
    std::string bytes_;
    std::map<std::string, Tensor> fields_;
};

} // namespace alhazen
