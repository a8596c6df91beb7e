"""Hosts for the published page: a plain one without any head, Python's with `_headers`, and nginx, Apache and Caddy with the files of
hosting/, where their programs are installed.

    with plain(folder) as host: host.url, host.asked
    for host in real(folder): with host: ...
"""
import functools
import http.server
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import serve  # noqa: E402


class PythonHost:
    """asked: paths, in order."""

    def __init__(self, name, folder, rules=(), port=0):
        self.name, self.asked, asked = name, [], None
        asked = self.asked

        class Handler(serve.Handler):
            def log_message(self, *_):
                asked.append(self.path)
        Handler.rules = rules
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", port), functools.partial(Handler, directory=str(folder)))
        self.port = self.server.server_address[1]
        self.url = f"http://127.0.0.1:{self.port}/"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def stop(self):
        self.server.shutdown()
        self.server.server_close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()


def plain(folder, port=0):
    return PythonHost("a plain host", folder, port=port)


def with_heads(folder):
    return PythonHost("a host with _headers", folder, serve.heads_of(folder))


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Program:
    """A server of others. words: how it is started; check: how it looks at its settings alone."""

    def __init__(self, name, folder, place, port, words, check):
        self.name, self.folder, self.place, self.words, self.check = name, folder, place, words, check
        self.url = f"http://127.0.0.1:{port}/"
        self.port = port

    def __enter__(self):
        looked = subprocess.run(self.check, capture_output=True, text=True)
        if looked.returncode != 0:
            raise RuntimeError(f"{self.name} refuses its settings: {looked.stderr or looked.stdout}")
        self.said = open(self.place / "said", "w+")
        self.process = subprocess.Popen(self.words, stdout=self.said, stderr=self.said, stdin=subprocess.DEVNULL)
        for _ in range(100):
            with socket.socket() as one:
                if one.connect_ex(("127.0.0.1", self.port)) == 0:
                    return self
            if self.process.poll() is not None:
                break
            time.sleep(0.1)
        self.__exit__()
        raise RuntimeError(f"{self.name} does not answer: {(self.place / 'said').read_text()}")

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(20)
        self.said.close()
        shutil.rmtree(self.place, ignore_errors=True)


def nginx(program, folder, place, port):
    (place / "nginx.conf").write_text(f"""daemon off; pid {place}/pid; error_log stderr; {'user root;' if os.getuid() == 0 else ''}
events {{ }}
http {{
  access_log off;
  {' '.join(f'{one}_temp_path {place}/{one};' for one in ('client_body', 'proxy', 'fastcgi', 'uwsgi', 'scgi'))}
  server {{ listen 127.0.0.1:{port}; root {folder}; include {folder}/hosting/nginx.conf; }}
}}
""")
    words = [program, "-p", str(place), "-c", str(place / "nginx.conf")]
    return Program("nginx", folder, place, port, words, words + ["-t"])


def apache(program, folder, place, port):
    modules = pathlib.Path(program).resolve().parents[1] / "lib/apache2/modules"
    load = "\n".join(f"LoadModule {one}_module {modules}/mod_{one}.so" for one in
                     ("mpm_event", "authz_core", "dir", "mime", "headers", "rewrite", "setenvif"))
    (place / "mime.types").write_text("text/html html\ntext/css css\n")
    (place / "apache.conf").write_text(f"""{load}
ServerName 127.0.0.1
Listen 127.0.0.1:{port}
PidFile {place}/pid
ErrorLog {place}/errors
TypesConfig {place}/mime.types
DocumentRoot {folder}
<Directory {folder}>
  AllowOverride FileInfo Indexes
  Options FollowSymLinks
  Require all granted
</Directory>
""")
    words = [program, "-d", str(place), "-f", str(place / "apache.conf")]
    return Program("Apache", folder, place, port, words + ["-D", "FOREGROUND"], words + ["-t"])


def caddy(program, folder, place, port):
    (place / "Caddyfile").write_text(
        f"{{\n admin off\n auto_https off\n}}\nhttp://127.0.0.1:{port} {{\n root * {folder}\n import {folder}/hosting/caddy.conf\n}}\n")
    settings = ["--config", str(place / "Caddyfile"), "--adapter", "caddyfile"]
    return Program("Caddy", folder, place, port, [program, "run", *settings], [program, "validate", *settings])


def real(folder):
    """The hosts whose programs are there, and the names of the others. BURR_HOSTS: folders where programs lie besides PATH."""
    path = os.pathsep.join([os.environ.get("BURR_HOSTS", ""), os.environ["PATH"], "/usr/sbin"])
    found, missing = [], []
    for name, make in (("nginx", nginx), ("apache2", apache), ("caddy", caddy)):
        program = shutil.which(name, path=path)
        if program:
            place = pathlib.Path(tempfile.mkdtemp(prefix="burr_host_"))
            found.append(make(program, pathlib.Path(folder).resolve(), place, free_port()))
        else:
            missing.append(name)
    return found, missing
