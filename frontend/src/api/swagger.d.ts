declare module "swagger-ui-dist/swagger-ui-es-bundle.js" {
  /** Draws the description into the page; its settings: swagger.io/docs. */
  export default function SwaggerUI(settings: {
    dom_id: string;
    url: string;
    deepLinking: boolean;
    validatorUrl: string | null;
  }): unknown;
}
