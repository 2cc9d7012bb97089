// The socket to the robot. It comes back by itself when the line was cut.

const AGAIN_MS = 1500;

/** Listen; `heard` has hello(greeting), moment(bytes), state(state), refused(sentence), cut(). */
export function link(heard) {
  const address = new URL("socket", document.baseURI);
  address.protocol = address.protocol.replace("http", "ws");
  let socket = null;
  const open = () => {
    let greeted = null;
    socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }) => {
      if (typeof data === "string") {
        const told = JSON.parse(data);
        if (!greeted) heard.hello((greeted = told));
        else if (told.state) heard.state(told.state);
        else if (told.refused) heard.refused(told.refused);
      } else heard.moment(data);
    };
    socket.onclose = ({ reason }) => {
      heard.cut(reason);
      setTimeout(open, AGAIN_MS);
    };
  };
  open();
  return (order) => socket.readyState === WebSocket.OPEN && socket.send(JSON.stringify(order));
}
