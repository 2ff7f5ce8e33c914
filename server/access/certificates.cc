#include "server/access/certificates.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <algorithm>
#include <ctime>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"

namespace traverse {
namespace {

struct FreeBio {
  void operator()(BIO* bio) const { BIO_free(bio); }
};
struct FreeX509 {
  void operator()(X509* certificate) const { X509_free(certificate); }
};
struct FreeKey {
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
};
using BioPtr = std::unique_ptr<BIO, FreeBio>;
using X509Ptr = std::unique_ptr<X509, FreeX509>;
using KeyPtr = std::unique_ptr<EVP_PKEY, FreeKey>;

absl::Status Unusable(const char* what, const std::string& path, absl::string_view why) {
  return absl::InvalidArgumentError(absl::StrCat("cannot use the ", what, " ", path, ": ", why));
}

BioPtr Reader(const std::string& text) {
  return BioPtr(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

std::vector<X509Ptr> ParseCertificates(const std::string& text) {
  const BioPtr bio = Reader(text);
  std::vector<X509Ptr> certificates;
  while (X509* next = PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr)) {
    certificates.emplace_back(next);
  }
  ERR_clear_error();  // the error that no more follow
  return certificates;
}

// Never asks for a passphrase.
int NoPassphrase(char* /*buffer*/, int /*size*/, int /*writing*/, void* /*data*/) { return 0; }

KeyPtr ParseKey(const std::string& text) {
  const BioPtr bio = Reader(text);
  KeyPtr key(PEM_read_bio_PrivateKey(bio.get(), nullptr, NoPassphrase, nullptr));
  ERR_clear_error();
  return key;
}

absl::Time Expiry(const X509& certificate) {
  std::tm end{};
  if (ASN1_TIME_to_tm(X509_get0_notAfter(&certificate), &end) != 1) return absl::InfinitePast();
  return absl::FromTM(end, absl::UTCTimeZone());
}

std::string ExpiredAt(absl::Time time) {
  return absl::StrCat("it expired on ",
                      absl::FormatTime("%Y-%m-%d at %H:%M UTC", time, absl::UTCTimeZone()));
}

absl::Status ReadChain(const TlsOptions& tls, absl::Time now, CertificateSet& set) {
  constexpr char kWhat[] = "certificate";
  absl::StatusOr<std::string> text = ReadTextFile(tls.certificate);
  if (!text.ok()) return Unusable(kWhat, tls.certificate, text.status().message());
  const std::vector<X509Ptr> chain = ParseCertificates(*text);
  if (chain.empty())
    return Unusable(kWhat, tls.certificate, "contains no certificate in PEM format");
  set.expiry = absl::InfiniteFuture();
  for (const X509Ptr& one : chain) set.expiry = std::min(set.expiry, Expiry(*one));
  if (set.expiry <= now) return Unusable(kWhat, tls.certificate, ExpiredAt(set.expiry));
  absl::StatusOr<std::string> key_text = ReadTextFile(tls.key);
  if (!key_text.ok()) return Unusable("private key", tls.key, key_text.status().message());
  const KeyPtr key = ParseKey(*key_text);
  if (key == nullptr)
    return Unusable("private key", tls.key, "contains no unencrypted private key in PEM format");
  if (X509_check_private_key(chain.front().get(), key.get()) != 1) {
    ERR_clear_error();
    return Unusable("private key", tls.key,
                    absl::StrCat("it does not belong to the certificate ", tls.certificate));
  }
  set.chain = *std::move(text);
  set.key = *std::move(key_text);
  return absl::OkStatus();
}

absl::Status ReadAuthorities(const TlsOptions& tls, absl::Time now, CertificateSet& set) {
  constexpr char kWhat[] = "authorities of clients";
  absl::StatusOr<std::string> text = ReadTextFile(tls.client_ca);
  if (!text.ok()) return Unusable(kWhat, tls.client_ca, text.status().message());
  const std::vector<X509Ptr> authorities = ParseCertificates(*text);
  if (authorities.empty())
    return Unusable(kWhat, tls.client_ca, "contains no certificate in PEM format");
  set.ca_expiry = absl::InfinitePast();
  for (const X509Ptr& one : authorities) set.ca_expiry = std::max(set.ca_expiry, Expiry(*one));
  if (set.ca_expiry <= now) return Unusable(kWhat, tls.client_ca, ExpiredAt(set.ca_expiry));
  set.client_ca = *std::move(text);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<CertificateSet> ReadCertificates(const TlsOptions& tls, absl::Time now) {
  if (tls.certificate.empty() || tls.key.empty()) {
    return absl::InvalidArgumentError("TLS needs both a certificate and a private key");
  }
  CertificateSet set;
  set.ca_expiry = absl::InfiniteFuture();
  if (absl::Status status = ReadChain(tls, now, set); !status.ok()) return status;
  if (tls.client_ca.empty()) return set;
  if (absl::Status status = ReadAuthorities(tls, now, set); !status.ok()) return status;
  return set;
}

absl::StatusOr<std::shared_ptr<CertificateStore>> CertificateStore::Make(
    const TlsOptions& tls, std::function<void(const absl::Status&)> on_reload) {
  std::shared_ptr<CertificateStore> store(new CertificateStore(tls, std::move(on_reload)));
  const MutexLock looking(store->looking_);
  const MutexLock lock(store->mutex_);
  store->states_ = store->StatesNow();
  absl::StatusOr<CertificateSet> set = ReadCertificates(tls, absl::Now());
  if (!set.ok()) return set.status();
  store->current_ = std::make_shared<const CertificateSet>(*std::move(set));
  return store;
}

std::shared_ptr<const CertificateSet> CertificateStore::current() const {
  MutexLock lock(mutex_);
  return current_;
}

CertificateStore::States CertificateStore::StatesNow() const {
  return {StateOfFile(tls_.certificate), StateOfFile(tls_.key), StateOfFile(tls_.client_ca)};
}

void CertificateStore::Look(bool anyway) {
  MutexLock looking(looking_);
  // Before the files are read: what changes in between is seen the next time.
  const States states = StatesNow();
  if (states == states_ && !anyway) return;
  states_ = states;
  absl::StatusOr<CertificateSet> set = ReadCertificates(tls_, absl::Now());
  if (set.ok()) {
    MutexLock lock(mutex_);
    current_ = std::make_shared<const CertificateSet>(*std::move(set));
  }
  on_reload_(set.status());
}

}  // namespace traverse
