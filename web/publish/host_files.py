"""The files that tell a host which head to send with the published page: `_headers`, .htaccess, hosting/."""

# Besides the policy. No COOP and no COEP: the page shares no memory, and a learning management system may open it.
FENCES = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
}
FOREVER = "public, max-age=31536000, immutable"  # for what its hash names
ASK = "no-cache"  # for all others: the browser asks each time whether it has changed
TYPES = {".html": "text/html; charset=utf-8", ".js": "text/javascript; charset=utf-8", ".mjs": "text/javascript; charset=utf-8",
         ".css": "text/css; charset=utf-8", ".json": "application/json; charset=utf-8", ".wasm": "application/wasm",
         ".txt": "text/plain; charset=utf-8"}
PARTS = "/v-[0-9a-f]{16}/"


def plain_hosts(fences, parts):
    """`_headers`, which Netlify, Cloudflare Pages and others read. A host may join two values of one name: each name stands once."""
    lines = ["/*"] + [f"  {name}: {value}" for name, value in fences.items()]
    lines += [f"/{parts}/*", f"  Cache-Control: {FOREVER}", "/sw.js", f"  Cache-Control: {ASK}", ""]
    return "\n".join(lines)


def nginx(fences):
    def head(keep):
        return "".join(f'  add_header {name} "{value}" always;\n' for name, value in {**fences, "Cache-Control": keep}.items())
    types = "".join(f"    {kind.split(';')[0]} {end[1:]};\n" for end, kind in TYPES.items() if end != ".js")
    types = types.replace("text/javascript mjs;", "text/javascript js mjs;")
    return f"""# The page of burr at the root of a server of nginx:
#
#   server {{
#     listen 443 ssl;  # ... with your name and certificate
#     root /usr/share/burr/web;
#     include /usr/share/burr/web/hosting/nginx.conf;
#   }}
#
# `brotli_static on;` beside gzip_static sends the smaller .br, with Debian's libnginx-mod-http-brotli-static.
index index.html;
gzip_static on;
gzip_vary on;
charset utf-8;
charset_types text/html text/javascript text/css application/json text/plain;
types {{
{types}}}
location / {{
{head(ASK)}}}
location ~ "{PARTS}" {{
{head(FOREVER)}}}
location ~ "/(hosting/|_headers$|\\.ht)" {{
  return 404;
}}
"""


def apache(fences):
    head = "".join(f'  Header always set {name} "{value}"\n' for name, value in fences.items())
    packed = ""
    for code, end in (("br", "br"), ("gzip", "gz")):
        packed += f"""    RewriteCond %{{HTTP:Accept-Encoding}} \\b{code}\\b
    RewriteCond %{{REQUEST_FILENAME}}.{end} -f
    RewriteRule \\.(html|js|mjs|css|json|wasm)$ %{{REQUEST_URI}}.{end} [L]
"""
    types = "".join(f"    RewriteRule \\{end}\\.(br|gz)$ - [T={kind.split(';')[0]},E=no-gzip:1,E=no-brotli:1]\n"
                    for end, kind in TYPES.items() if end != ".txt")
    plain = "".join(f"AddType {kind.split(';')[0]} {end}\n" for end, kind in TYPES.items())
    return f"""# The page of burr for Apache, wherever it lies on the server. As .htaccess it needs AllowOverride FileInfo Indexes;
# otherwise copy it into <Directory>. Modules: headers, rewrite, mime, dir, setenvif.
DirectoryIndex index.html
{plain}AddDefaultCharset utf-8
RemoveType .gz .br
RemoveLanguage .br
<IfModule mod_rewrite.c>
  RewriteEngine On
  RewriteRule (^|/)(hosting/|_headers$|\\.ht) - [R=404,L]
</IfModule>
<IfModule mod_headers.c>
  <IfModule mod_rewrite.c>
{packed}{types}  </IfModule>
  <FilesMatch "\\.br$">
    Header always set Content-Encoding br
  </FilesMatch>
  <FilesMatch "\\.gz$">
    Header always set Content-Encoding gzip
  </FilesMatch>
{head}  Header always set Cache-Control "{ASK}"
  Header always set Cache-Control "{FOREVER}" "expr=%{{REQUEST_URI}} =~ m#{PARTS}#"
  Header always append Vary Accept-Encoding
</IfModule>
"""


def caddy(fences):
    head = "".join(f'  {name} "{value}"\n' for name, value in fences.items())
    return f"""# The page of burr for Caddy:
#
#   school.example {{
#     root * /usr/share/burr/web
#     import /usr/share/burr/web/hosting/caddy.conf
#   }}
@burr_parts path_regexp {PARTS}
@burr_other not path_regexp {PARTS}
@burr_hidden path */hosting/* */_headers */.htaccess
respond @burr_hidden 404
header {{
{head}}}
header @burr_parts Cache-Control "{FOREVER}"
header @burr_other Cache-Control "{ASK}"
file_server {{
  precompressed br gzip
}}
"""


def host_files(fences, parts):
    """Path -> text."""
    return {"_headers": plain_hosts(fences, parts), ".htaccess": apache(fences), "hosting/nginx.conf": nginx(fences),
            "hosting/apache.conf": apache(fences), "hosting/caddy.conf": caddy(fences)}
