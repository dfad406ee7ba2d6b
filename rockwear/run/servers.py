"""The servers that YADE opens on localhost when it starts: a Python prompt, and XMLRPC with the run's progress."""
import gc
import os
import socket
import socketserver
import threading

HANDLERS = {"PythonConsoleSocketEmulator", "InfoProvider"}
"""Classes of yade.remote that answer at these servers."""


def close():
    """Close YADE's servers, except in a yade-batch, whose overview asks them. Without any there is nothing to do.

    YADE keeps no reference to them other than their threads.
    """
    if os.environ.get("YADE_BATCH"):
        return
    for server in [found for found in gc.get_objects() if issubclass(type(found), socketserver.TCPServer)]:
        if HANDLERS & {server.RequestHandlerClass.__name__, type(getattr(server, "instance", None)).__name__}:
            _close(server)


def _close(server):
    """End the server's loop and close its socket."""
    ending = threading.Thread(target=server.shutdown, daemon=True)
    ending.start()
    # Without this the loop would see the request to end only after its poll interval of half a second.
    server.socket.shutdown(socket.SHUT_RDWR)
    ending.join(timeout=2.0)
    server.server_close()
