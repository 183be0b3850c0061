// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstring>
#include <new>
#include <utility>

#include <dds/ddsi/q_radmin.h>

#include <io/dds/cdr_type.hpp>

namespace penumbra::io {
namespace {

// Cyclone DDS calls these functions from C: they must not throw. A null sample means "out of
// memory".

struct CdrType : ddsi_sertype {
  std::shared_ptr<ArrivalCounts> counts;
};

// Samples may outlive their type, so they share ownership of its counts.
struct CdrSample : ddsi_serdata {
  std::unique_ptr<std::byte[]> bytes;
  std::uint32_t size = 0;
  std::shared_ptr<ArrivalCounts> counts;  // for received samples
  std::atomic<bool> taken = false;
};

const CdrSample* sample_of(const ddsi_serdata* data) { return static_cast<const CdrSample*>(data); }
CdrSample* sample_of(ddsi_serdata* data) { return static_cast<CdrSample*>(data); }

/// Makes a sample. The protocol sends multiples of four bytes, so the size is rounded up and the
/// padding is zero.
CdrSample* new_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  std::unique_ptr<CdrSample> sample(new (std::nothrow) CdrSample);
  if (!sample) return nullptr;
  const std::size_t whole = (size + 3) & ~std::size_t{3};
  sample->bytes.reset(new (std::nothrow) std::byte[std::max<std::size_t>(whole, 4)]);
  if (!sample->bytes) return nullptr;
  std::fill(sample->bytes.get() + size, sample->bytes.get() + std::max<std::size_t>(whole, 4),
            std::byte{0});
  sample->size = static_cast<std::uint32_t>(size);
  ddsi_serdata_init(sample.get(), type, kind);
  return sample.release();
}

ddsi_serdata* count_arrival(CdrSample* sample) {
  if (sample->kind != SDK_DATA) return sample;
  sample->counts = static_cast<const CdrType*>(sample->type)->counts;
  if (sample->counts) ++sample->counts->received;
  return sample;
}

/// Offsets of fields by RTPS 2.3 (9.4.4, 9.4.5.3, 9.4.5.4), in bytes from the start of a packet,
/// and of a DATA or DATA_FRAG in it.
constexpr std::size_t guid_prefix_at = 8, writer_at = 12, number_at = 16, header_end = 24;

/// Counts lost samples by the writer's sequence number, which Cyclone DDS does not pass on but
/// leaves in the packet.
void note_number(const CdrSample& sample, const nn_rdata& fragment) {
  const std::size_t start = NN_RDATA_SUBMSG_OFF(&fragment);
  const auto* const packet = reinterpret_cast<const std::byte*>(NN_RMSG_PAYLOAD(fragment.rmsg));
  const bool whole = start >= 20 && start + header_end <= NN_RDATA_PAYLOAD_OFF(&fragment);
  if (!sample.counts || !whole || std::memcmp(packet, "RTPS", 4) != 0) return;
  const std::byte* const message = packet + start;
  const bool little = (message[1] & std::byte{1}) != std::byte{0};
  if (little != (std::endian::native == std::endian::little)) return;
  ArrivalCounts::Writer writer;
  std::memcpy(writer.data(), packet + guid_prefix_at, 12);
  std::memcpy(writer.data() + 12, message + writer_at, 4);
  std::int32_t high = 0;
  std::uint32_t low = 0;
  std::memcpy(&high, message + number_at, sizeof(high));
  std::memcpy(&low, message + number_at + 4, sizeof(low));
  sample.counts->note_number(writer, (std::int64_t{high} << 32) | low);
}

bool keys_are_equal(const ddsi_serdata*, const ddsi_serdata*) { return true; }  // no keys

std::uint32_t size_of(const ddsi_serdata* data) { return sample_of(data)->size; }

ddsi_serdata* from_network(const ddsi_sertype* type, ddsi_serdata_kind kind,
                           const nn_rdata* fragment, std::size_t size) {
  CdrSample* const sample = new_sample(type, kind, size);
  if (sample == nullptr) return nullptr;
  std::size_t filled = 0;
  const nn_rdata* const first = fragment;
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= filled) continue;  // fragments may overlap
    if (fragment->min > filled) break;
    const unsigned char* const payload =
        NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    const std::size_t end = std::min<std::size_t>(fragment->maxp1, size);
    if (end <= filled) break;
    std::memcpy(sample->bytes.get() + filled, payload + (filled - fragment->min), end - filled);
    filled = end;
  }
  std::fill(sample->bytes.get() + filled, sample->bytes.get() + size, std::byte{0});
  count_arrival(sample);
  if (first != nullptr) note_number(*sample, *first);
  return sample;
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind,
                          ddsrt_msg_iovlen_t count, const ddsrt_iovec_t* pieces, std::size_t size) {
  CdrSample* const sample = new_sample(type, kind, size);
  if (sample == nullptr) return nullptr;
  std::size_t filled = 0;
  for (ddsrt_msg_iovlen_t i = 0; i < count && filled < size; ++i) {
    const std::size_t length = std::min<std::size_t>(pieces[i].iov_len, size - filled);
    std::memcpy(sample->bytes.get() + filled, pieces[i].iov_base, length);
    filled += length;
  }
  std::fill(sample->bytes.get() + filled, sample->bytes.get() + size, std::byte{0});
  return count_arrival(sample);
}

ddsi_serdata* from_key_hash(const ddsi_sertype* type, const ddsi_keyhash*) {
  return new_sample(type, SDK_KEY, 0);
}

/// Cyclone calls this to dispose of instances. Samples have no C representation here.
ddsi_serdata* from_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void*) {
  return kind == SDK_DATA ? nullptr : new_sample(type, kind, 0);
}

void to_bytes(const ddsi_serdata* data, std::size_t offset, std::size_t size, void* to) {
  std::memcpy(to, sample_of(data)->bytes.get() + offset, size);
}

ddsi_serdata* lend_bytes(const ddsi_serdata* data, std::size_t offset, std::size_t size,
                         ddsrt_iovec_t* piece) {
  piece->iov_base = sample_of(data)->bytes.get() + offset;
  piece->iov_len = size;
  return ddsi_serdata_ref(data);
}

void return_bytes(ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); }

bool to_sample(const ddsi_serdata*, void*, void**, void*) { return false; }

bool untyped_to_sample(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
  return false;
}

ddsi_serdata* to_untyped(const ddsi_serdata* data) {
  CdrSample* const key = new_sample(data->type, SDK_KEY, 0);
  if (key != nullptr) key->type = nullptr;
  return key;
}

void free_sample(ddsi_serdata* data) {
  const std::unique_ptr<CdrSample> sample(sample_of(data));
  if (sample->counts && !sample->taken) ++sample->counts->overwritten;
}

std::size_t print_sample(const ddsi_sertype*, const ddsi_serdata*, char* to, std::size_t size) {
  if (size > 0) *to = '\0';
  return 0;
}

void key_hash(const ddsi_serdata*, ddsi_keyhash* to, bool) { *to = {}; }

const ddsi_serdata_ops sample_functions = {keys_are_equal,
                                           size_of,
                                           from_network,
                                           from_pieces,
                                           from_key_hash,
                                           from_sample,
                                           to_bytes,
                                           lend_bytes,
                                           return_bytes,
                                           to_sample,
                                           to_untyped,
                                           untyped_to_sample,
                                           free_sample,
                                           print_sample,
                                           key_hash
#ifdef DDS_HAS_SHM
                                           ,
                                           nullptr,
                                           nullptr
#endif
};

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete static_cast<CdrType*>(type);
}

// Only dds_takecdr and dds_writecdr are called. They need no samples in the C representation.
void zero_samples(const ddsi_sertype*, void*, std::size_t) {}
void realloc_samples(void**, const ddsi_sertype*, void*, std::size_t, std::size_t) {}
void free_samples(const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {}

bool are_equal(const ddsi_sertype* a, const ddsi_sertype* b) { return a == b; }  // by identity
std::uint32_t hash_type(const ddsi_sertype*) { return 0; }

const ddsi_sertype_ops type_functions = {
    ddsi_sertype_v0, nullptr, free_type, zero_samples, realloc_samples, free_samples, are_equal,
    hash_type,       nullptr, nullptr,   nullptr,      nullptr,         nullptr,      nullptr};

}  // namespace

void ArrivalCounts::note_number(const Writer& writer, std::int64_t number) {
  const std::lock_guard lock(mutex_);
  const auto [last, first] = last_.try_emplace(writer, number);
  if (!first && number > last->second) {
    lost += static_cast<std::uint64_t>(number - last->second - 1);
    last->second = number;
  }
  if (last_.size() > most_writers) last_.clear();  // bounds the memory if publishers come and go
}

ddsi_sertype* make_cdr_type(const std::string& dds_name, std::shared_ptr<ArrivalCounts> counts) {
  auto type = std::make_unique<CdrType>();
  type->counts = std::move(counts);
  ddsi_sertype_init(type.get(), dds_name.c_str(), &type_functions, &sample_functions, true);
  return type.release();
}

ddsi_serdata* make_cdr_sample(const ddsi_sertype* type, std::span<const std::byte> bytes) {
  CdrSample* const sample = new_sample(type, SDK_DATA, bytes.size());
  if (sample == nullptr) throw std::bad_alloc();
  std::copy(bytes.begin(), bytes.end(), sample->bytes.get());
  return sample;
}

std::span<const std::byte> cdr_bytes(const ddsi_serdata* sample) {
  return {sample_of(sample)->bytes.get(), sample_of(sample)->size};
}

std::shared_ptr<const void> own_taken(ddsi_serdata* sample) {
  sample_of(sample)->taken = true;
  return {sample, [](const void* data) {
            ddsi_serdata_unref(const_cast<ddsi_serdata*>(static_cast<const ddsi_serdata*>(data)));
          }};
}

}  // namespace penumbra::io
