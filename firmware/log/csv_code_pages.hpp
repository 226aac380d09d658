#pragma once
#include <string>
#include <string_view>

#include "firmware/log/csv_text.hpp"

// Code pages of one byte per character, and UTF-32.
namespace sandhopper {

bool is_utf8(std::string_view bytes);
void put_utf8(std::string& out, char32_t character);

// Code page of bytes that are no UTF-8. Windows-1251 if whole words are of its Cyrillic letters, with
// capitals only at their beginning or throughout; Mac Roman if bytes that are capitals or signs in
// Windows-1252 follow on small letters; else Windows-1252.
TextEncoding code_page_of(std::string_view bytes);

// Bytes of a code page as UTF-8. A byte without a character becomes U+FFFD.
std::string from_code_page(std::string_view bytes, TextEncoding page);

std::string from_utf32(std::string_view bytes, bool big_endian);

// True for words, read as Windows-1252, of two or more letters beyond ASCII and no other: another code page.
bool has_words_beyond_ascii(std::string_view utf8);

}  // namespace sandhopper
