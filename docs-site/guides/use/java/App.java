import fc.Client;
import fc.runtime.ClientConfig;

public final class App {
    private App() {}

    public static void main(String[] arguments) throws Exception {
        ClientConfig config =
                new ClientConfig().host("127.0.0.1").commandPort(Integer.parseInt(arguments[0]));
        try (Client client = Client.connectAsync(config).get()) {
            System.out.println(client.getRobotSnAsync().get().getData().getRobotSn());
        }
    }
}
