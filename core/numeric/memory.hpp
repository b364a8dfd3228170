// Fixed-size memory that is made at creation and never grows: 64-byte aligned for FFT and SIMD.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace railpatch {

// Pages of the system's, all zeros, for buffers that may stay empty for the greater part: those
// that are never used take no memory. Throws std::bad_alloc.
void *take_pages(size_t bytes);
void give_pages(void *pages, size_t bytes);

template <class T>
class aligned_buffer {
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  aligned_buffer() = default;
  // Zeros. Those of a large buffer are the system's own, so that pages never used are never
  // touched.
  explicit aligned_buffer(size_t count) : count_(count) {
    if constexpr (std::is_trivially_default_constructible_v<T>) {
      if (count * sizeof(T) >= large) {
        data_ = {static_cast<T *>(take_pages(count * sizeof(T))), release{count * sizeof(T)}};
        return;
      }
    }
    data_.reset(allocate(count));
    std::uninitialized_value_construct_n(data_.get(), count);
  }
  // Leaves the values undefined, so that pages never used are never touched.
  static aligned_buffer uninitialized(size_t count) {
    aligned_buffer buffer;
    buffer.data_.reset(allocate(count));
    buffer.count_ = count;
    return buffer;
  }

  T *data() { return data_.get(); }
  const T *data() const { return data_.get(); }
  size_t size() const { return count_; }
  size_t bytes() const { return count_ * sizeof(T); }
  T &operator[](size_t i) { return data_.get()[i]; }
  const T &operator[](size_t i) const { return data_.get()[i]; }
  T *begin() { return data(); }
  T *end() { return data() + count_; }

 private:
  static constexpr std::align_val_t alignment{64};
  static constexpr size_t large = size_t{1} << 16;
  struct release {
    size_t pages = 0;  // bytes of pages of the system's; 0: of operator new
    void operator()(T *p) const {
      if (pages > 0)
        give_pages(p, pages);
      else
        ::operator delete[](static_cast<void *>(p), alignment);
    }
  };
  static T *allocate(size_t count) {
    return static_cast<T *>(::operator new[](count * sizeof(T), alignment));
  }
  std::unique_ptr<T[], release> data_;
  size_t count_ = 0;
};

}  // namespace railpatch
