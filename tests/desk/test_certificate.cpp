#include <doctest/doctest.h>
#include <memory>
#include <openssl/x509.h>
#include <string>

#include "desk/connection.h"

using namespace palpa::desk;

namespace {

// A desk whose certificate is good from `from_s` to `until_s`, counted from now.
TlsContext desk_with(long from_s, long until_s) {
    const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> key(EVP_EC_gen("P-256"), &EVP_PKEY_free);
    const std::unique_ptr<X509, decltype(&X509_free)> certificate(X509_new(), &X509_free);
    X509_gmtime_adj(X509_getm_notBefore(certificate.get()), from_s);
    X509_gmtime_adj(X509_getm_notAfter(certificate.get()), until_s);
    X509_set_pubkey(certificate.get(), key.get());
    REQUIRE(X509_sign(certificate.get(), key.get(), EVP_sha256()) > 0);
    TlsContext tls(SSL_CTX_new(TLS_server_method()));
    REQUIRE(SSL_CTX_use_certificate(tls.get(), certificate.get()) == 1);
    return tls;
}

}  // namespace

TEST_CASE("certificate: one that has ended, or does not begin yet, is named with its date") {
    constexpr long kDay_s = 86400;
    CHECK(out_of_date(*desk_with(-kDay_s, kDay_s)).empty());
    CHECK(out_of_date(*desk_with(-kDay_s, -60)).find("was good until 20") != std::string::npos);
    CHECK(out_of_date(*desk_with(60, kDay_s)).find("is not good before 20") != std::string::npos);
}
