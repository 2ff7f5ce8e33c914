#include "client/gateway/http/tls_context.h"

#include <arpa/inet.h>
#include <openssl/x509v3.h>

#include <boost/asio/buffer.hpp>
#include <utility>

#include "absl/strings/str_cat.h"

namespace traverse::gateway {
namespace {

absl::StatusOr<std::shared_ptr<TlsContext::Context>> ContextOf(const CertificateSet& set) {
  using Context = TlsContext::Context;
  auto context = std::make_shared<Context>(Context::tls_server);
  boost::system::error_code error;
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION);
  context->use_certificate_chain(boost::asio::buffer(set.chain), error);
  if (!error) context->use_private_key(boost::asio::buffer(set.key), Context::pem, error);
  if (!error && !set.client_ca.empty()) {
    context->add_certificate_authority(boost::asio::buffer(set.client_ca), error);
    if (!error) {
      context->set_verify_mode(
          boost::asio::ssl::verify_peer | boost::asio::ssl::verify_fail_if_no_peer_cert, error);
    }
    // Without it, resuming a session fails where clients are verified.
    SSL_CTX_set_session_id_context(context->native_handle(),
                                   reinterpret_cast<const unsigned char*>("traverse"), 8);
  }
  if (error) {
    return absl::UnavailableError(
        absl::StrCat("OpenSSL does not accept the certificate with its key: ", error.message()));
  }
  return context;
}

std::string TextOf(const ASN1_STRING* text) {
  return std::string(reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)),
                     static_cast<size_t>(ASN1_STRING_length(text)));
}

std::string AddressOf(const std::string& bytes) {
  char text[INET6_ADDRSTRLEN] = "";
  const int family = bytes.size() == 4 ? AF_INET : AF_INET6;
  if (bytes.size() != 4 && bytes.size() != 16) return "";
  inet_ntop(family, bytes.data(), text, sizeof(text));
  return text;
}

std::vector<std::string> AlternativeNames(X509* certificate) {
  std::vector<std::string> out;
  auto* names = static_cast<GENERAL_NAMES*>(
      X509_get_ext_d2i(certificate, NID_subject_alt_name, nullptr, nullptr));
  for (int i = 0; i < sk_GENERAL_NAME_num(names); ++i) {
    const GENERAL_NAME* name = sk_GENERAL_NAME_value(names, i);
    int type = 0;
    const void* value = GENERAL_NAME_get0_value(name, &type);
    if (type == GEN_DNS || type == GEN_EMAIL || type == GEN_URI) {
      out.push_back(TextOf(static_cast<const ASN1_STRING*>(value)));
    } else if (type == GEN_IPADD) {
      out.push_back(AddressOf(TextOf(static_cast<const ASN1_STRING*>(value))));
    }
  }
  GENERAL_NAMES_free(names);
  return out;
}

}  // namespace

absl::StatusOr<std::unique_ptr<TlsContext>> TlsContext::Make(
    std::shared_ptr<CertificateStore> store) {
  std::unique_ptr<TlsContext> made(new TlsContext(std::move(store)));
  made->set_ = made->store_->current();
  absl::StatusOr<std::shared_ptr<Context>> context = ContextOf(*made->set_);
  if (!context.ok()) return context.status();
  made->context_ = *std::move(context);
  return made;
}

std::shared_ptr<TlsContext::Context> TlsContext::Current() {
  std::shared_ptr<const CertificateSet> set = store_->current();
  if (set == set_) return context_;
  set_ = std::move(set);
  absl::StatusOr<std::shared_ptr<Context>> context = ContextOf(*set_);
  if (context.ok()) context_ = *std::move(context);
  return context_;
}

std::vector<std::string> PeerIdentities(SSL* ssl) {
  X509* certificate = SSL_get1_peer_certificate(ssl);
  if (certificate == nullptr) return {};
  std::vector<std::string> out = AlternativeNames(certificate);
  if (out.empty()) {
    X509_NAME* subject = X509_get_subject_name(certificate);
    const int at = X509_NAME_get_index_by_NID(subject, NID_commonName, -1);
    if (at >= 0) {
      out.push_back(TextOf(X509_NAME_ENTRY_get_data(X509_NAME_get_entry(subject, at))));
    }
  }
  X509_free(certificate);
  return out;
}

}  // namespace traverse::gateway
