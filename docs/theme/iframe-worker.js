/* Search, from disk too. A page that is opened as a file may not start a worker: its script runs in a hidden
   frame then, which is given what a worker has. Elsewhere nothing is changed. */

class FrameWorker extends EventTarget {
  constructor(url) {
    super();
    this.waiting = [];
    this.frame = document.createElement("iframe");
    this.frame.hidden = true;
    this.frame.title = "search";
    this.frame.srcdoc = "<!doctype html>";
    this.frame.addEventListener("load", () => this.begin(url), { once: true });
    document.body.append(this.frame);
  }

  /* Let the script find the functions of a worker, then run it. */
  async begin(url) {
    const scope = this.frame.contentWindow;
    scope.postMessage = (data) => this.dispatchEvent(new MessageEvent("message", { data }));
    scope.importScripts = async (...urls) => {
      for (const each of urls) await this.load(new URL(each, url));
    };
    await this.load(url);
    const waiting = this.waiting;
    this.waiting = null;
    waiting.forEach((data) => this.postMessage(data));
  }

  load(url) {
    return new Promise((resolve, reject) => {
      const script = this.frame.contentDocument.createElement("script");
      script.src = url;
      script.onload = resolve;
      script.onerror = reject;
      this.frame.contentDocument.body.append(script);
    });
  }

  postMessage(data) {
    if (this.waiting) {
      this.waiting.push(data);
      return;
    }
    const scope = this.frame.contentWindow;
    scope.dispatchEvent(new scope.MessageEvent("message", { data }));
  }

  terminate() {
    this.frame.remove();
  }
}

if (location.protocol === "file:") window.Worker = window.IFrameWorker = FrameWorker;
