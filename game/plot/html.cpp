#include "game/plot/html.hpp"

#include <fmt/format.h>

#include <cmath>

namespace bolt::plot {

namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";
constexpr std::string_view minus = "\xE2\x88\x92";

bool is_continuation(std::string_view text, std::size_t at) {
    return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
}

// Length of the UTF-8 sequence at `at`; 0 if it is invalid, overlong or a surrogate.
std::size_t sequence_length(std::string_view text, std::size_t at) {
    const auto lead = static_cast<unsigned char>(text[at]);
    if (lead < 0x80U) return 1;
    if (lead < 0xC2U || lead > 0xF4U) return 0;
    const std::size_t length = lead < 0xE0U ? 2 : lead < 0xF0U ? 3 : 4;
    for (std::size_t i = 1; i < length; ++i)
        if (!is_continuation(text, at + i)) return 0;
    const auto second = static_cast<unsigned char>(text[at + 1]);
    const bool overlong = (lead == 0xE0U && second < 0xA0U) || (lead == 0xF0U && second < 0x90U);
    const bool beyond = (lead == 0xEDU && second > 0x9FU) || (lead == 0xF4U && second > 0x8FU);
    return overlong || beyond ? 0 : length;
}

void append_ascii(std::string& out, char c) {
    switch (c) {
        case '&':
            out += "&amp;";
            return;
        case '<':
            out += "&lt;";
            return;
        case '>':
            out += "&gt;";
            return;
        case '"':
            out += "&quot;";
            return;
        case '\'':
            out += "&#39;";
            return;
        default:
            break;
    }
    const bool forbidden = static_cast<unsigned char>(c) < 0x20U && c != '\n' && c != '\t' && c != '\r';
    if (forbidden || c == '\x7F')
        out += replacement;
    else
        out += c;
}

std::string with_minus(std::string digits) {
    if (digits.empty() || digits.front() != '-') return digits;
    const bool zero = digits.find_first_of("123456789") == std::string::npos;
    digits.erase(0, 1);
    return zero ? digits : std::string(minus) + digits;
}

}  // namespace

std::string escape(std::string_view text) {
    std::string out;
    out.reserve(text.size() + text.size() / 8);
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = sequence_length(text, i);
        if (length == 0)
            out += replacement;
        else if (length == 1)
            append_ascii(out, text[i]);
        else
            out += text.substr(i, length);
        i += length == 0 ? 1 : length;
    }
    return out;
}

std::string number(double value, int decimals) {
    if (!std::isfinite(value)) return "\xE2\x80\x93";
    return with_minus(fmt::format("{:.{}f}", value, decimals));
}

std::string signed_number(double value, int decimals) {
    const std::string text = number(value, decimals);
    const bool plus = value > 0.0 && text.find_first_of("123456789") != std::string::npos;
    return plus ? "+" + text : text;
}

std::string duration_text(double seconds) {
    if (!std::isfinite(seconds)) return number(seconds, 0);
    if (seconds < 59.95) return number(seconds, 1) + " s";
    const double whole = std::round(seconds);
    const double minutes = std::floor(whole / 60.0);
    const double rest = whole - 60.0 * minutes;
    if (minutes < 60.0) return fmt::format("{:.0f} min {:02.0f} s", minutes, rest);
    const double hours = std::floor(minutes / 60.0);
    return fmt::format("{:.0f} h {:02.0f} min {:02.0f} s", hours, minutes - 60.0 * hours, rest);
}

std::string_view style_sheet() {
    return R"css(
:root{color-scheme:light dark;--paper:#ffffff;--panel:#f7f8f9;--ink:#1b1f24;--mute:#626b76;--faint:#9aa3ad;--rule:#e2e5e9;
--accent:#0a6c8f;--p1:#5a9fb8;--p0:#a3c6d3;--ok:#2b7a3d;--low:#a86300;--high:#b3261e;--win:#2b7a3d;
--s1:#eef0f3;--s2:#e4e8ec;--s3:#f3e8d8;--rest:#8fbccd;--edge:rgba(27,31,36,.3)}
@media screen and (prefers-color-scheme:dark){:root{--paper:#14171b;--panel:#1b1f24;--ink:#e6e9ec;--mute:#9ba5b0;
--faint:#6c7681;--rule:#2b3138;--accent:#5dbbdd;--p1:#4a97b3;--p0:#3b7389;--ok:#6cc483;--low:#e0a54a;--high:#f2857c;
--win:#6cc483;--s1:#1d2228;--s2:#232931;--s3:#332b1f;--rest:#7fa9ba;--edge:rgba(230,233,236,.34)}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"Noto Sans",
"DejaVu Sans",sans-serif;font-variant-numeric:tabular-nums lining-nums;-webkit-text-size-adjust:100%}
main{max-width:1120px;margin:0 auto;padding:40px 32px 64px}
h1{font-size:27px;line-height:1.2;font-weight:600;letter-spacing:-.01em;margin:0}
h2{font-size:18px;font-weight:600;margin:44px 0 6px}
h3{font-size:14.5px;font-weight:600;margin:0}h4{font-size:13px;font-weight:500;margin:0}
.trainee{margin-top:30px;padding-top:14px;border-top:1px solid var(--rule)}h3 .of{color:var(--mute);font-weight:400;font-size:12.5px;margin-left:10px}
p{margin:6px 0 12px;max-width:76ch}.note,figcaption{color:var(--mute);font-size:13px;line-height:1.45}
.over{color:var(--mute);font-size:13px;margin:0 0 6px}
a{color:var(--accent)}
section.session{border-top:1px solid var(--rule);margin-top:56px;padding-top:36px}
section.alone{border:0;margin:0;padding:0}
.head{display:flex;flex-wrap:wrap;gap:16px 40px;justify-content:space-between;align-items:flex-start}
.head>div:first-child{flex:1 1 380px}
.score{display:flex;gap:36px}.score div{min-width:84px}
.big{display:block;font-size:34px;line-height:1.1;font-weight:600;letter-spacing:-.02em;color:var(--accent)}
.big small{font-size:15px;font-weight:400;color:var(--mute);letter-spacing:0}
dl.facts{display:grid;grid-template-columns:repeat(auto-fill,minmax(108px,1fr));gap:14px 20px;margin:26px 0 0;
padding:16px 0;border-top:1px solid var(--rule);border-bottom:1px solid var(--rule)}
dl.facts div{min-width:0}dl.facts .path{grid-column:1/-1}dl.facts .path dd{overflow-wrap:normal;word-break:keep-all;overflow-x:auto}dt{color:var(--mute);font-size:12.5px}dd{margin:0;overflow-wrap:anywhere}
.banner{margin:22px 0 0;padding:12px 16px;border:1px solid var(--low);border-left-width:5px;border-radius:4px;
background:var(--panel)}
.scroll{overflow-x:auto;-webkit-overflow-scrolling:touch;background:linear-gradient(to right,var(--paper) 50%,transparent) 0 0/64px 100% no-repeat local,
linear-gradient(to left,var(--paper) 50%,transparent) 100% 0/64px 100% no-repeat local,
linear-gradient(to right,var(--edge),transparent) 0 0/22px 100% no-repeat scroll,
linear-gradient(to left,var(--edge),transparent) 100% 0/22px 100% no-repeat scroll}
table{border-collapse:collapse;width:100%;font-size:13.5px;margin:10px 0 4px}
th{font-weight:500;color:var(--mute);text-align:left;font-size:12.5px;vertical-align:bottom;
border-bottom:1px solid var(--faint);padding:4px 12px 6px 0}
td{border-bottom:1px solid var(--rule);padding:6px 12px 6px 0;vertical-align:baseline;white-space:nowrap}
th.n,td.n{text-align:right}td.w{white-space:normal;min-width:14em}
th:last-child,td:last-child{padding-right:0}tr.sum td{font-weight:600;border-bottom:0}
td .of,td small{color:var(--mute);font-size:12.5px;font-weight:400}
.v{font-weight:600;white-space:nowrap}.v.vo{color:var(--ok)}.v.vl{color:var(--low)}.v.vh{color:var(--high)}
.v.vn{color:var(--mute);font-weight:400}
.fh .v{font-size:13.5px}
.bad{color:var(--high);font-weight:600}
.grid{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,440px),1fr));gap:30px 36px;margin-top:18px}
.small{grid-template-columns:repeat(auto-fill,minmax(min(100%,300px),1fr));gap:22px 30px}
.quad{grid-template-columns:repeat(auto-fill,minmax(min(100%,220px),1fr));gap:22px 26px}
.tiny{grid-template-columns:repeat(auto-fill,minmax(min(100%,200px),1fr));gap:14px 18px}
.wide{grid-template-columns:minmax(0,1fr)}
.grid>*{min-width:0}figure{margin:0}figure svg{display:block;width:100%;max-width:620px;height:auto;margin-top:4px}
figcaption{margin-top:2px}.fh{display:flex;flex-wrap:wrap;gap:0 14px;align-items:baseline;justify-content:space-between}
.legend{display:flex;flex-wrap:wrap;gap:6px 20px;font-size:13px;color:var(--mute);margin:10px 0 0;padding:0;list-style:none}
.legend li{display:flex;align-items:center;gap:7px}.legend svg{width:22px;height:14px;flex:none}
footer{margin-top:56px;padding-top:14px;border-top:1px solid var(--rule);color:var(--mute);font-size:13px}
svg text{fill:var(--ink);font:11px system-ui,-apple-system,"Segoe UI",Roboto,"Noto Sans","DejaVu Sans",sans-serif;
font-variant-numeric:tabular-nums lining-nums}
svg .mid{text-anchor:middle}svg .end{text-anchor:end}
svg .tk,svg .lb,svg .sm,svg .st{fill:var(--mute)}svg .sm,svg .st{font-size:10px}svg .wn{fill:var(--low);font-size:10px}
svg .mk{font-weight:600;paint-order:stroke;stroke:var(--paper);stroke-width:3px;stroke-linejoin:round}
svg .no{font-weight:500}
svg .sm,svg .wn{paint-order:stroke;stroke:var(--paper);stroke-width:2.5px;stroke-opacity:.75}
.ax{stroke:var(--faint)}.gr{stroke:var(--rule);stroke-width:.75}
.s0{fill:none}.s1{fill:var(--s1)}.s2{fill:var(--s2)}.s3{fill:var(--s3)}
.win{fill:var(--win);fill-opacity:.13}.wins{fill:var(--win);fill-opacity:.55}.tgt{stroke:var(--win);stroke-width:1.1}.mean{stroke:var(--mute);stroke-dasharray:3 3}
.ln{fill:none;stroke-width:1.7;stroke-linejoin:round;stroke-linecap:round}
.p0{stroke:var(--p0)}.p1{stroke:var(--p1)}.p2{stroke:var(--accent)}
.cl{stroke:var(--mute);stroke-width:1.1;stroke-dasharray:4 3}
.me{stroke:var(--ink);stroke-width:1;stroke-opacity:.32}.me1{stroke:var(--ink);stroke-width:1.3}
.rest{stroke:var(--rest);stroke-width:.9}.ld{stroke:var(--faint);stroke-width:.75}
.in{stroke:var(--accent);stroke-width:1}.inset{fill:var(--paper);stroke:var(--rule)}
.mpeak{fill:var(--accent);stroke:var(--paper);stroke-width:1.2}.mbreak{fill:none;stroke:var(--mute);stroke-width:1.2}.mclamp{fill:var(--paper);stroke:var(--mute);stroke-width:1.2}
.dd{fill:var(--paper);stroke:var(--accent);stroke-width:1.6}.dw{fill:var(--paper);stroke:var(--low);stroke-width:2.4}
.dn{fill:var(--paper);stroke:var(--faint);stroke-dasharray:3 3}
.oa{stroke:var(--faint);stroke-width:1.1;stroke-dasharray:2 4}.of{stroke:var(--accent);stroke-width:1.3;stroke-opacity:.75}
.ah{fill:var(--accent)}
.bf{fill:var(--s2)}.bar.vo{fill:var(--ok)}.bar.vl{fill:var(--low)}.bar.vh{fill:var(--high)}.bar.vn{fill:var(--faint)}
.cln{stroke:var(--mute);stroke-width:1.4}
@media (max-width:640px){main{padding:24px 16px 40px}h1{font-size:22px}h2{margin-top:34px}.score{gap:24px}
.big{font-size:28px}dl.facts{grid-template-columns:1fr 1fr;gap:12px 18px}
svg text{font-size:13px}svg .sm,svg .st,svg .wn{font-size:12px}}
@media print{@page{margin:14mm}body{font-size:10.5pt}main{max-width:none;padding:0}
.grid{grid-template-columns:repeat(2,minmax(0,1fr));gap:16px 20px}.small,.quad{grid-template-columns:repeat(3,minmax(0,1fr))}
.tiny{grid-template-columns:repeat(4,minmax(0,1fr))}.wide{grid-template-columns:minmax(0,1fr)}figure,tr,.head,dl{break-inside:avoid}
h2,h3{break-after:avoid}.trainee{break-inside:avoid}section.session{break-before:page;border:0}section.alone{break-before:auto}
.scroll{overflow:visible;background:none}*{-webkit-print-color-adjust:exact;print-color-adjust:exact}}
)css";
}

std::string page(std::string_view title, std::string_view body, std::string_view head) {
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
        "<title>{}</title>\n{}<style>{}</style>\n</head>\n<body>\n<main>\n{}</main>\n</body>\n</html>\n",
        escape(title), head, style_sheet(), body);
}

std::string figure(std::string_view heading, std::string_view svg, std::string_view caption) {
    std::string out = "<figure>";
    if (!heading.empty()) out += fmt::format("<div class=\"fh\">{}</div>", heading);
    out += svg;
    if (!caption.empty()) out += fmt::format("<figcaption>{}</figcaption>", caption);
    return out + "</figure>\n";
}

std::string fact(std::string_view name, std::string_view value) {
    return value.empty() ? std::string()
                         : fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, escape(value));
}

std::string path_fact(std::string_view name, std::string_view path) {
    if (path.empty()) return {};
    std::string html;
    for (std::size_t from = 0; from < path.size();) {
        const std::size_t slash = path.find('/', from);
        const std::size_t end = slash == std::string_view::npos ? path.size() : slash + 1;
        if (from > 0) html += "<wbr/>";
        html += escape(path.substr(from, end - from));
        from = end;
    }
    return fmt::format("<div class=\"path\"><dt>{}</dt><dd>{}</dd></div>\n", name, html);
}

}  // namespace bolt::plot
