/// ROS 1 messages from and to CDR bytes, the encoding of ROS 2.
///
/// Works for each message whose fields are the same in ROS 1 and ROS 2; the `seq` of a header,
/// which ROS 2 does not have, is left alone. Source: OMG CDR version 1, little endian: four header
/// bytes, numbers aligned to their size counted from behind the header, strings with a length that
/// counts their final zero.
#pragma once

#include <ros/serialization.h>
#include <std_msgs/Header.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace hapticgiant {

inline constexpr std::size_t kCdrHeader = 4;  // bytes

/// Stream for the serializers of ROS that reads CDR.
class CdrReader {
 public:
  explicit CdrReader(std::string_view bytes) : bytes_(bytes) {
    is_ok_ = bytes.size() >= kCdrHeader && bytes[0] == 0 && bytes[1] == 1;
  }

  /// False once the bytes ended too early or were not little-endian CDR.
  bool is_ok() const { return is_ok_; }

  template <typename T>
  void next(T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      position_ += (sizeof(T) - (position_ - kCdrHeader) % sizeof(T)) % sizeof(T);
      copy(&value, sizeof(T));
    } else {
      ros::serialization::Serializer<T>::read(*this, value);
    }
  }

  void next(std::string& text) {
    text.resize(length());
    copy(text.data(), text.size());
    if (!text.empty()) text.pop_back();
  }

  void next(ros::Time& time) {
    next(time.sec);
    next(time.nsec);
  }

  void next(std_msgs::Header& header) {
    next(header.stamp);
    next(header.frame_id);
  }

  template <typename T, typename Allocator>
  void next(std::vector<T, Allocator>& items) {
    items.resize(length());
    for (T& item : items) next(item);
  }

 private:
  // An item takes at least one byte, so that a wrong length cannot ask for more than there is.
  std::size_t length() {
    std::uint32_t length = 0;
    next(length);
    is_ok_ = is_ok_ && length <= bytes_.size() - position_;
    return is_ok_ ? length : 0;
  }

  void copy(void* data, std::size_t size) {
    is_ok_ = is_ok_ && position_ + size <= bytes_.size();
    if (is_ok_ && size > 0) std::memcpy(data, bytes_.data() + position_, size);
    position_ += size;
  }

  std::string_view bytes_;
  std::size_t position_ = kCdrHeader;
  bool is_ok_;
};

/// Stream for the serializers of ROS that writes CDR.
class CdrWriter {
 public:
  const std::string& bytes() const { return bytes_; }

  template <typename T>
  void next(const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      while ((bytes_.size() - kCdrHeader) % sizeof(T) != 0) bytes_ += '\0';
      append(&value, sizeof(T));
    } else {
      ros::serialization::Serializer<T>::write(*this, value);
    }
  }

  void next(const std::string& text) {
    next(static_cast<std::uint32_t>(text.size() + 1));
    append(text.c_str(), text.size() + 1);
  }

  void next(const ros::Time& time) {
    next(time.sec);
    next(time.nsec);
  }

  void next(const std_msgs::Header& header) {
    next(header.stamp);
    next(header.frame_id);
  }

  template <typename T, typename Allocator>
  void next(const std::vector<T, Allocator>& items) {
    next(static_cast<std::uint32_t>(items.size()));
    for (const T& item : items) next(item);
  }

 private:
  void append(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }

  std::string bytes_ = std::string("\0\1\0\0", kCdrHeader);
};

/// Decodes a message; false: the bytes are not one.
template <typename Message>
bool from_cdr(std::string_view bytes, Message& message) {
  CdrReader reader(bytes);
  reader.next(message);
  return reader.is_ok();
}

template <typename Message>
std::string to_cdr(const Message& message) {
  CdrWriter writer;
  writer.next(message);
  return writer.bytes();
}

}  // namespace hapticgiant
