#include "server/credentials.h"

#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>
#include <openssl/asn1.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <cstdio>
#include <ctime>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"

namespace traverse {
namespace {

constexpr unsigned kLookEverySeconds = 1;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct FreeX509 {
  void operator()(X509* certificate) const { X509_free(certificate); }
};
struct FreeKey {
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
};
using FilePtr = std::unique_ptr<std::FILE, CloseFile>;
using X509Ptr = std::unique_ptr<X509, FreeX509>;
using KeyPtr = std::unique_ptr<EVP_PKEY, FreeKey>;

absl::Status Unusable(const std::string& what, const std::string& path, const char* why) {
  return absl::UnavailableError(absl::StrCat("cannot use the ", what, " ", path, ": ", why));
}

// The first certificate of a PEM file.
absl::StatusOr<X509Ptr> ReadCertificate(const std::string& what, const std::string& path) {
  const FilePtr file(std::fopen(path.c_str(), "r"));
  if (file == nullptr) return Unusable(what, path, "it cannot be read");
  X509Ptr certificate(PEM_read_X509(file.get(), nullptr, nullptr, nullptr));
  if (certificate == nullptr) return Unusable(what, path, "no certificate in PEM");
  return certificate;
}

// A passphrase is never asked for.
int NoPassphrase(char* /*buffer*/, int /*size*/, int /*writing*/, void* /*data*/) { return 0; }

absl::StatusOr<KeyPtr> ReadKey(const std::string& path) {
  const FilePtr file(std::fopen(path.c_str(), "r"));
  if (file == nullptr) return Unusable("private key", path, "it cannot be read");
  KeyPtr key(PEM_read_PrivateKey(file.get(), nullptr, NoPassphrase, nullptr));
  if (key == nullptr) return Unusable("private key", path, "no unencrypted private key in PEM");
  return key;
}

// gRPC says nothing about bad files until somebody connects.
absl::Status CheckFiles(const TlsOptions& tls) {
  if (tls.certificate.empty() || tls.key.empty()) {
    return absl::InvalidArgumentError("TLS needs both a certificate and a private key");
  }
  absl::StatusOr<X509Ptr> certificate = ReadCertificate("certificate", tls.certificate);
  if (!certificate.ok()) return certificate.status();
  absl::StatusOr<KeyPtr> key = ReadKey(tls.key);
  if (!key.ok()) return key.status();
  if (X509_check_private_key(certificate->get(), key->get()) != 1) {
    return Unusable("private key", tls.key,
                    absl::StrCat("it is not that of the certificate ", tls.certificate).c_str());
  }
  if (tls.client_ca.empty()) return absl::OkStatus();
  return ReadCertificate("authorities of clients", tls.client_ca).status();
}

}  // namespace

bool IsLoopback(const std::string& address) {
  if (absl::StartsWith(address, "unix:") || absl::StartsWith(address, "unix-abstract:")) {
    return true;
  }
  const std::string host = address.substr(0, address.rfind(':'));
  if (host == "localhost" || host == "[::1]" || host == "::1") return true;
  // 127.0.0.0/8, and no name such as 127.example.org.
  return absl::StartsWith(host, "127.") &&
         host.find_first_not_of("0123456789.") == std::string::npos;
}

absl::StatusOr<std::shared_ptr<grpc::ServerCredentials>> MakeServerCredentials(
    const TlsOptions& tls, const std::string& listen, bool insecure) {
  if (!tls.enabled()) {
    if (!insecure && !IsLoopback(listen)) {
      return absl::InvalidArgumentError(absl::StrCat(
          listen,
          " can be reached from other machines: give --tls_certificate and --tls_key, or "
          "--insecure for plaintext"));
    }
    return grpc::InsecureServerCredentials();
  }
  if (absl::Status status = CheckFiles(tls); !status.ok()) return status;
  using grpc::experimental::FileWatcherCertificateProvider;
  const bool mutual = !tls.client_ca.empty();
  const auto provider = mutual ? std::make_shared<FileWatcherCertificateProvider>(
                                     tls.key, tls.certificate, tls.client_ca, kLookEverySeconds)
                               : std::make_shared<FileWatcherCertificateProvider>(
                                     tls.key, tls.certificate, kLookEverySeconds);
  grpc::experimental::TlsServerCredentialsOptions options(provider);
  options.watch_identity_key_cert_pairs();
  if (mutual) {
    options.watch_root_certs();
    options.set_cert_request_type(GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  }
  return grpc::experimental::TlsServerCredentials(options);
}

std::optional<absl::Time> CertificateExpiry(const std::string& path) {
  absl::StatusOr<X509Ptr> certificate = ReadCertificate("certificate", path);
  if (!certificate.ok()) return std::nullopt;
  std::tm end{};
  if (ASN1_TIME_to_tm(X509_get0_notAfter(certificate->get()), &end) != 1) return std::nullopt;
  return absl::FromTM(end, absl::UTCTimeZone());
}

}  // namespace traverse
