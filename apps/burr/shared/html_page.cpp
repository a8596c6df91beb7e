#include "shared/html_page.h"

namespace burr::app {

const char* const kPageStyle =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:70em;margin:2em auto;padding:0 1em;"
    "color:#222}h1{font-size:1.3em}figure{display:inline-block;width:48%;margin:0 1% 1em 0}"
    "img{width:100%}figcaption{color:#666;font-size:.9em}td{padding:.15em 1.2em .15em 0;"
    "vertical-align:top}td:first-child{color:#666}.spare{color:#b00;font-weight:600}"
    "footer{color:#888;font-size:.85em;margin-top:1.5em}@media print{body{margin:0}}";

}  // namespace burr::app
